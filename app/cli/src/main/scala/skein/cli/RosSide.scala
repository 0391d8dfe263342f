package skein.cli

import org.apache.pekko.actor.ActorSystem
import skein.airsim.WorldSettings
import skein.ros.{RosNode, SimulatedTopics}
import skein.simulator.{CommandCounts, SimulatorServer}
import skein.units.Clock

/** The node of `./skein serve --ros`, and its messages for a person. */
private[cli] final class RosSide private (node: RosNode, val topics: SimulatedTopics):
  private var said   = Set.empty[String]
  private var counts = (skipped = 0L, images = 0L, refused = 0L, failed = 0L, missed = 0L, late = 0L)
  private var served = Option.empty[SimulatorServer]

  /** Lets the topics fly the vehicles and show their sensors, and prints what is missing. */
  def fly(server: SimulatorServer, world: WorldSettings)(using ActorSystem): Unit =
    served = Some(server)
    val here = Reachable.from(server.address).getOrElse(server.address)
    for line <- topics.missing ++ topics.fly(server).left.toOption ++ topics.show(world, here).left.toOption
    do
      Console.out.println(s"ROS 2: $line")

  /** A line for each fault since the last call. */
  def news(): Seq[String] =
    val commands = served.fold(CommandCounts.Zero)(_.commands)
    val now      = (
      skipped = topics.skipped,
      images = topics.skippedImages,
      refused = node.refused,
      failed = node.failed,
      missed = commands.missed,
      late = commands.late
    )
    val lines = (node.notes ++ topics.notes).filterNot(said)
    val count = Option.when(now != counts):
      ServerNews.happened(
        now.skipped -> "moments not published, the machine is too slow",
        now.images  -> "images or scans not published",
        now.refused -> "messages refused",
        now.failed  -> "messages not sent",
        now.missed  -> "stops of the clock without a command",
        now.late    -> "commands left out, received after a later one"
      ).mkString(", ")
    said ++= lines
    counts = now
    (lines ++ count).map("ROS 2: " + _)

  def close(): Unit =
    topics.close()
    node.close()

private[cli] object RosSide:
  /** Opens the node `skein` and the topics of vehicles with these names.
    *
    * @return Left if ROS 2 is not installed, or does not allow it
    */
  def open(names: Vector[String]): Either[String, RosSide] =
    for
      _      <- SimulatedTopics.mistake(names).toLeft(())
      node   <- RosNode.open("skein", Clock.system)
      topics <- SimulatedTopics.open(node, names).left.map: why =>
        node.close()
        why
    yield RosSide(node, topics)
