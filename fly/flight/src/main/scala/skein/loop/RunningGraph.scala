package skein.loop

import org.apache.pekko.stream.Materializer
import org.apache.pekko.stream.snapshot.{MaterializerState, RunningInterpreter}
import scala.concurrent.{ExecutionContext, Future}

/** The parts and edges of a graph, by name.
  *
  * @param stages names of the parts
  */
final case class LoopGraph(stages: Vector[String], edges: Vector[(from: String, to: String)])

object LoopGraph:

  /** The graph of numbered operators and their connections: operators of one name form one part, and those
    * without a name are skipped, with edges through them joined.
    */
  def of(names: Vector[Option[String]], connections: Vector[(from: Int, to: Int)]): LoopGraph =
    val next                            = connections.groupMap(_.from)(_.to).withDefaultValue(Vector.empty)
    def reached(from: Int): Vector[Int] =
      def walk(unnamed: Set[Int], front: Vector[Int], found: Vector[Int]): Vector[Int] = front match
        case at +: rest if names(at).isDefined => walk(unnamed, rest, found :+ at)
        case at +: rest if unnamed(at)         => walk(unnamed, rest, found)
        case at +: rest                        => walk(unnamed + at, rest ++ next(at), found)
        case _                                 => found
      walk(Set.empty, next(from), Vector.empty)
    val edges =
      for
        (name, at) <- names.zipWithIndex
        from       <- name.toVector
        other      <- reached(at)
        to         <- names(other) if to != from
      yield (from = from, to = to)
    // The interpreter has no order of its own.
    LoopGraph(names.flatten.distinct.sorted, edges.distinct.sortBy(edge => (edge.from, edge.to)))

/** The graph of a running loop, as its interpreter reports it: the parts with one of these meters.
  *
  * @param streams its materializer, once it runs
  * @param controller the vehicle whose controller it is, where each vehicle has one
  */
final class RunningGraph(
    val meters: StageMeters,
    streams: Future[Materializer],
    val controller: Option[String] = None
)(using ExecutionContext):

  /** Requests the graph from the interpreter. Absent while it does not run. */
  def shape(): Future[Option[LoopGraph]] =
    streams
      .flatMap(MaterializerState.streamSnapshots)
      .map(_.iterator.flatMap(_.activeInterpreters).map(shapeOf).find(_.stages.nonEmpty))

  private def shapeOf(running: RunningInterpreter): LoopGraph =
    val places = running.logics.zipWithIndex.toMap
    LoopGraph.of(
      running.logics.toVector.map(_.attributes.get[StageMeter].filter(_.of eq meters).map(_.name)),
      // `in` owns the inlet, so the connection leads to it.
      running.connections.toVector.flatMap(one => places.get(one.out).zip(places.get(one.in)))
    )
