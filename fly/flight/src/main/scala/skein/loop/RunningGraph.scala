package skein.loop

import org.apache.pekko.stream.Materializer
import org.apache.pekko.stream.snapshot.{MaterializerState, RunningInterpreter}
import scala.concurrent.{ExecutionContext, Future}

/** The parts of a graph and what leads from one to another, both by names.
  *
  * @param stages their names
  */
final case class LoopGraph(stages: Vector[String], edges: Vector[(from: String, to: String)])

object LoopGraph:

  /** Operators by number, and what leads from operator to operator: those of one name are one part, and those
    * without a name are left out; what leads through them leads on.
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

/** The graph of a loop under way, as its interpreter runs it: the parts that bear one of these meters.
  *
  * @param streams what it runs on, as soon as it does
  */
final class RunningGraph(val meters: StageMeters, streams: Future[Materializer])(using ExecutionContext):

  /** Asks the interpreter. Absent while the graph does not run. */
  def shape(): Future[Option[LoopGraph]] =
    streams
      .flatMap(MaterializerState.streamSnapshots)
      .map(_.iterator.flatMap(_.activeInterpreters).map(shapeOf).find(_.stages.nonEmpty))

  private def shapeOf(running: RunningInterpreter): LoopGraph =
    val places = running.logics.zipWithIndex.toMap
    LoopGraph.of(
      running.logics.toVector.map(_.attributes.get[StageMeter].filter(_.of eq meters).map(_.name)),
      // `in` owns the inlet, and so is where the connection leads to.
      running.connections.toVector.flatMap(one => places.get(one.out).zip(places.get(one.in)))
    )
