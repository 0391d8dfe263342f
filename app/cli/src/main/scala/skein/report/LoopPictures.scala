package skein.report

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, Future}
import skein.figures.{Figure, GraphFigure}
import skein.loop.{AnyLoop, LoopGraph, LoopInstance, LoopKind, LoopSettings}
import skein.measure.FlightSet
import skein.policy.Fleet
import skein.scenario.Scenarios

/** Graphs of the loops of a set of flights, each drawn for its number of vehicles. */
object LoopPictures:

  /** @param isInPacket whether its commands carry plans */
  final case class Loop(kind: AnyLoop, fleet: Fleet, isInPacket: Boolean = false)

  /** Maximum number of vehicles in a readable picture. */
  private val MostVehicles = 8

  /** Pictures of the loops; blocks, since it starts each loop for a moment. */
  def of(set: FlightSet)(using Scenarios): Vector[Figure] =
    val flown =
      for
        summary <- set.all
        kind    <- AnyLoop.parse(summary.flight.loop).toOption
        known   <- summary.scenario
      yield Loop(kind, known.fleet, summary.isInPacket && kind == LoopKind.Predictive)
    drawn(flown.filter(_.fleet.agents.size <= MostVehicles).distinctBy(loop =>
      (loop.kind, loop.fleet.agents.map(_.name), loop.isInPacket)
    ))

  /** Pictures of those loops that are graphs. Blocks. */
  def drawn(loops: Seq[Loop]): Vector[Figure] =
    for (loop, graph) <- graphs(loops)
    yield Figure(
      s"graph-${loop.kind.label}" + (if loop.isInPacket then "-in-packet" else "") +
        (if loop.fleet.agents.size == 2 then "" else s"-${loop.fleet.agents.size}"),
      s"The graph of ${loop.kind.label}" + (if loop.isInPacket then " with plans in packets" else ""),
      "The stages by their names in the code, as the stream's interpreter runs them. The edge below feeds " +
        "back.",
      GraphFigure(graph)
    )

  private[report] def graphs(loops: Seq[Loop]): Vector[(Loop, LoopGraph)] =
    if loops.isEmpty then Vector.empty
    else
      given system: ActorSystem = ActorSystem("skein-graphs")
      import system.dispatcher
      try
        val asked = Future.traverse(loops.toVector)(loop =>
          LoopInstance
            .graph(loop.kind, loop.fleet, LoopSettings(planInPacket = loop.isInPacket))
            .map(_.map((loop, _)))
        )
        Await.result(asked, Within).flatten
      finally Await.result(system.terminate(), Within): Unit

  private val Within = 30.seconds
