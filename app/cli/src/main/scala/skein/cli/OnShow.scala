package skein.cli

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.ExecutionContext
import skein.flight.{LiveFlights, OutsideRequests}
import skein.loop.{GraphLayout, LoopGraph, RunningGraph}
import skein.record.{ImagingSensor, Recordable, RecordingHeader, Topic}
import skein.scene.Scene
import skein.scenario.Scenario
import skein.units.{Clock, Span}
import skein.view.{FlightControl, Feed, Gauge, LiveShow, Shows}

/** Live flights in the viewer, each with its records and its running graph. */
private[cli] final class OnShow(
    shows: Shows,
    requests: OutsideRequests,
    scene: Scene,
    sensors: Vector[ImagingSensor],
    scenario: Scenario
):
  private val graphs = ConcurrentHashMap[String, GraphGauge]()

  /** Starts showing a flight; the result receives its records. */
  def observe(heading: RecordingHeader): Recordable => Unit =
    val feed  = Feed()
    val gauge = GraphGauge()
    graphs.put(heading.flight.id, gauge): Unit
    val graph    = Gauge(OnShow.topic, Span.ofMillis(500), () => Some(gauge.json()))
    val controls =
      FlightControl.values.map(control => control -> (() => act(control, heading.flight.id)))
    shows.add(LiveShow(
      heading,
      feed,
      Vector(ScenarioGauge(scenario, heading.vehicles.map(_.name).toVector, Clock.system).gauge, graph),
      controls = controls.toMap,
      scene = scene,
      sensors = sensors
    ))
    feed.offer

  private def act(control: FlightControl, id: String): Unit = control match
    case FlightControl.Pause    => requests.pause(id, "paused from the page")
    case FlightControl.Continue => requests.continue(id, "continued from the page")
    case FlightControl.Abort    => requests.stop(id, "ended from the page")

  def flying(flights: LiveFlights): Unit =
    for
      (id, graph) <- flights.graphs
      gauge       <- Option(graphs.get(id))
    do gauge.graph.set(Some(graph))

private[cli] object OnShow:
  val topic: Topic = Topic(
    "/skein/graph",
    "skein.graph",
    """{"title":"skein.graph","type":"object","properties":{"stages":{"type":"array","items":{"type":"object","properties":{""" +
      """"name":{"type":"string"},"column":{"type":"integer"},"row":{"type":"number"},"entered":{"type":"integer"},"passed":{"type":"integer"},"unanswered":{"type":"integer"},""" +
      """"ageMs":{"type":"number"}}}},"edges":{"type":"array","items":{"type":"object","properties":{"from":{"type":"string"},""" +
      """"to":{"type":"string"}}}},"controller":{"type":"string"}}}"""
  )

/** A graph's meters for the viewer: queries the interpreter until the graph's parts are known, and reads the
  * meters each time.
  */
private[cli] final class GraphGauge:
  val graph: AtomicReference[Option[RunningGraph]] = AtomicReference(None)
  private val shape                                = AtomicReference(Option.empty[LoopGraph])

  def json(): String =
    val running = graph.get
    if shape.get.isEmpty then
      given ExecutionContext = ExecutionContext.parasitic
      for known <- running do known.shape().foreach(found => shape.compareAndSet(None, found))
    val known  = shape.get.getOrElse(LoopGraph(Vector.empty, Vector.empty))
    val spots  = GraphLayout.of(known)
    val meters = running.fold(Map.empty)(_.meters.all.map(meter => meter.name -> meter).toMap)
    val stages = known.stages.map: name =>
      val spot  = spots(name)
      val stage = ujson.Obj("name" -> name, "column" -> spot.column, "row" -> spot.row)
      for meter <- meters.get(name) do
        if meter.entered > 0 then stage("entered") = meter.entered.toDouble
        if meter.passed > 0 then stage("passed") = meter.passed.toDouble
        if name.startsWith("sense(") || name.startsWith("steer(") then
          stage("unanswered") = meter.unanswered.toDouble
        for age <- meter.age do stage("ageMs") = age.toMillis
      stage
    val arrows = known.edges.map(edge => ujson.Obj("from" -> edge.from, "to" -> edge.to))
    val drawn  = ujson.Obj("stages" -> ujson.Arr.from(stages), "edges" -> ujson.Arr.from(arrows))
    for name <- running.flatMap(_.controller) do drawn("controller") = name
    drawn.render()
