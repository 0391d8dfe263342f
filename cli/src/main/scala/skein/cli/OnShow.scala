package skein.cli

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.ExecutionContext
import skein.flight.LiveFlights
import skein.loop.{LoopGraph, RunningGraph}
import skein.record.{Heading, Record, Topic}
import skein.units.Span
import skein.view.{Feed, Gauge, LiveShow, Shows}

/** Live flights on show, each with its records and its graph as it runs. */
private[cli] final class OnShow(shows: Shows):
  private val graphs = ConcurrentHashMap[String, GraphGauge]()

  /** What is shown of a flight that begins. */
  def observe(heading: Heading): Record => Unit =
    val feed  = Feed()
    val gauge = GraphGauge()
    graphs.put(heading.flight.id, gauge): Unit
    val graph = Gauge(OnShow.topic, Span.ofMillis(500), gauge.json)
    shows.add(LiveShow(heading, feed, Vector(graph), abort = Some(() => gauge.abort.get.foreach(_()))))
    feed.offer

  /** These fly now. */
  def flying(flights: LiveFlights): Unit =
    for
      (id, graph) <- flights.graphs
      gauge       <- Option(graphs.get(id))
    do
      gauge.graph.set(Some(graph))
      gauge.abort.set(Some(() => flights.stop(id, "ended from the page")))

private[cli] object OnShow:
  val topic: Topic = Topic(
    "/skein/graph",
    "skein.graph",
    """{"title":"skein.graph","type":"object","properties":{"stages":{"type":"array","items":{"type":"object","properties":{""" +
      """"name":{"type":"string"},"entered":{"type":"integer"},"passed":{"type":"integer"},"unanswered":{"type":"integer"},""" +
      """"ageMs":{"type":"number"}}}},"edges":{"type":"array","items":{"type":"object","properties":{"from":{"type":"string"},""" +
      """"to":{"type":"string"}}}}}}"""
  )

/** A graph in numbers: its parts are asked for until the interpreter tells them, their meters each time. */
private[cli] final class GraphGauge:
  val graph: AtomicReference[Option[RunningGraph]] = AtomicReference(None)
  val abort: AtomicReference[Option[() => Unit]]   = AtomicReference(None)
  private val shape                                = AtomicReference(Option.empty[LoopGraph])

  def json(): String =
    val known = graph.get
    if shape.get.isEmpty then
      given ExecutionContext = ExecutionContext.parasitic
      for running <- known do running.shape().foreach(found => shape.compareAndSet(None, found))
    val LoopGraph(names, edges) = shape.get.getOrElse(LoopGraph(Vector.empty, Vector.empty))
    val meters                  = known.fold(Map.empty)(_.meters.all.map(meter => meter.name -> meter).toMap)
    val stages                  = names.map: name =>
      val stage = ujson.Obj("name" -> name)
      for meter <- meters.get(name) do
        if meter.entered > 0 then stage("entered") = meter.entered.toDouble
        if meter.passed > 0 then stage("passed") = meter.passed.toDouble
        if name.startsWith("sense(") || name.startsWith("steer(") then
          stage("unanswered") = meter.unanswered.toDouble
        for age <- meter.age do stage("ageMs") = age.toMillis
      stage
    val arrows = edges.map(edge => ujson.Obj("from" -> edge.from, "to" -> edge.to))
    ujson.Obj("stages" -> ujson.Arr.from(stages), "edges" -> ujson.Arr.from(arrows)).render()
