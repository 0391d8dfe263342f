package skein.rosbag

import scala.collection.mutable
import skein.mcap.Bytes
import skein.observe.{NewCommands, ObservedTopics, Progress}
import skein.ros.{Qos, RosGraph, RosNode, RosWatcher}
import skein.units.{Clock, Instant}

/** Measures the loop of a running graph of ROS 2, of any message types, by subscribing to its topics as they
  * appear. It publishes nothing. Methods may be called from any thread.
  *
  * Memory: [[GraphLoop.MostTopics]] topics, the beginnings of 16,384 messages, and that of
  * [[skein.observe.TopicAccount]]. What exceeds these limits is counted in the [[remarks]].
  *
  * @param readings topics with vehicles' readings; without any, those of poses whose name does not suggest
  *   commands
  * @param commands topics of commands; without any, those of twists and poses whose name suggests commands
  */
final class GraphLoop private[rosbag] (readings: Set[String], commands: Set[String], graph: RosGraph)
    extends RosWatcher,
      AutoCloseable:
  import GraphLoop.*

  private val loop     = TopicLoop(readings, commands)
  private val order    = ArrivalOrder()
  private val taken    = mutable.Set.empty[String]
  private val failed   = mutable.LinkedHashSet.empty[String]
  private var names    = Vector.empty[String]
  private var unheeded = 0

  def topics(found: Vector[(String, Vector[String])]): Unit = synchronized:
    names = found.map(_._1)
    val fresh =
      for
        (name, kinds) <- found if !taken(name)
        (kind, add)   <- kinds
          .flatMap(kind => loop.topic(name, kind, graph.definition(kind)).map(kind -> _)).headOption
      yield (name, kind, add)
    unheeded = (fresh.size - (MostTopics - taken.size)).max(0)
    for (name, kind, add) <- fresh.dropRight(unheeded) do
      taken += name
      graph
        .subscribeRaw(name, kind, Observing, TopicLoop.NeededBytes): (bytes, at) =>
          synchronized(order.add(at)(add(Bytes.of(bytes), at)))
        .left
        .foreach(failed += _)

  def upTo(at: Instant): Unit = synchronized(order.upTo(at))

  def progress: Progress = synchronized(loop.progress)

  /** Commands since the last call, for each vehicle. */
  def takeNew(): Vector[NewCommands] = synchronized(loop.takeNew())

  def observed: ObservedTopics = synchronized(loop.observed)

  /** Omissions, in one line each: topics that were chosen and did not appear, those that could not be
    * subscribed to or were too many, and messages that were refused or lost.
    */
  def remarks: Vector[String] = synchronized:
    val absent = loop.missing(taken).map: topic =>
      s"The topic $topic did not appear; the graph has ${listed(names)}."
    val more = Option.when(unheeded > 0)(s"$unheeded topics beyond the first $MostTopics were not observed.")
    val bad  = Option.when(graph.refused > 0)(s"${graph.refused} messages were refused.")
    val lost = Option.when(graph.lost > 0)(
      s"${graph.lost} messages were lost on their way to the observer: gaps may be its own."
    )
    absent ++ (failed.toVector ++ graph.notes).map(line => s"$line.") ++ more ++ bad ++ lost

  /** Ends the subscriptions; messages that arrived before are observed. */
  def close(): Unit =
    graph.close()
    upTo(Instant.ofNanos(Long.MaxValue))

object GraphLoop:
  private val MostTopics = 256
  private val MostListed = 12

  /** For each topic, up to 64 messages wait in the middleware for the observer; best effort and volatile
    * match every publisher.
    */
  private val Observing = Qos(isReliable = false, depth = 64)

  private def listed(names: Vector[String]) =
    val more = Option.when(names.size > MostListed)(s"${names.size - MostListed} more")
    if names.isEmpty then "none" else (names.take(MostListed) ++ more).mkString(", ")

  /** Joins the graph as the node `skein_observe`.
    *
    * @return Left if ROS 2 is not installed, or does not allow it
    */
  def open(readings: Set[String], commands: Set[String], clock: Clock): Either[String, GraphLoop] =
    RosNode.open("skein_observe", clock).map: node =>
      val loop = GraphLoop(readings, commands, node)
      node.watch(loop)
      loop
