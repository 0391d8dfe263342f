package skein.rosbag

import java.nio.file.{Files, Path}
import scala.collection.mutable
import skein.mcap.TopicMessage
import skein.mcap.file.McapFile
import skein.record.{MemoryRecorder, Recording}
import skein.ros.message.*
import skein.testing.{TemporaryFolders, Unhurried}

class RosBagSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:

  private lazy val flown: MemoryRecorder = Flown.stream(seconds = 10)

  /** The flight as a bag. */
  private lazy val (made, counts) =
    val folder = temporaryFolder()
    val file   = folder.resolve("flight.duckdb")
    assert(flown.writeTo(file).isRight)
    val made = folder.resolve("bag")
    (made, RosBag.write(file, made).fold(fail(_), identity))

  private def mean(values: Iterable[Double]) = values.sum / values.size

  test("a bag has every reading and command, and the ages of the newest readings behind commands"):
    val recording: Recording = flown.recording
    val loop                 = BagLoop(Set.empty, Set.empty).observed(made).fold(fail(_), identity)
    for name <- Vector("Pursuer", "Evader") do
      val readings = recording.readings.count(_.vehicle == name)
      val commands = recording.commands.filter(_.vehicle == name)
      assertEquals(counts(s"/$name/odom"), readings.toLong)
      assertEquals(counts(s"/$name/cmd_vel"), commands.size.toLong)
      val seen   = loop.vehicles.find(_.name == name).get
      val offset = recording.decisions.flatMap(_.trueAge).last.clockOffset
      val states = recording.readings.filter(_.vehicle == name).map(_.state)
      val ages   =
        for
          command <- commands
          newest  <- states.filter(_.receivedAt <= command.sentAt).maxByOption(_.validAt)
        yield command.sentAt.since(newest.validAt + offset).toMillis
      assertEquals(seen.commands, commands.size.toLong)
      assertEqualsDouble(seen.ownAgeMs.get.mean, mean(ages), 0.5, name)
    assertEquals(counts("/tf"), recording.readings.size.toLong)

  test("messages are CDR of the types that the bag defines"):
    McapFile.read(made.resolve("bag_0.mcap")): messages =>
      for case Right(message) <- messages do
        val bytes = message.message.data.toArray
        val read  = message.schema.get.name match
          case "nav_msgs/msg/Odometry"          => Cdr.message[Odometry](bytes)
          case "geometry_msgs/msg/TwistStamped" => Cdr.message[TwistStamped](bytes)
          case "tf2_msgs/msg/TFMessage"         => Cdr.message[TFMessage](bytes)
          case other                            => Left(other)
        assert(read.isRight, read)

  private def copy(messages: Vector[TopicMessage], to: Path): Unit = McapFile.write(to): mcap =>
    val channels = mutable.Map.empty[String, Int]
    for TopicMessage(channel, schema, message) <- messages do
      def made = mcap.channel(
        channel.topic,
        channel.messageEncoding,
        schema.fold(0)(kind => mcap.schema(kind.name, kind.encoding, kind.data))
      )
      val id = channels.getOrElseUpdate(channel.topic, made)
      mcap.message(id, message.sequence, message.logTime, message.publishTime, message.data)

  folder.test("the files of a split bag are read in the order of their messages, not of their names"):
    folder =>
      McapFile.read(made.resolve("bag_0.mcap")): messages =>
        val all           = messages.collect { case Right(message) => message }.toVector
        val (first, last) = all.splitAt(all.size / 2)
        copy(first, folder.resolve("bag_2.mcap"))
        copy(last, folder.resolve("bag_10.mcap"))
      def vehicles(bag: Path) = BagLoop(Set.empty, Set.empty).observed(bag).map(_.vehicles)
      assertEquals(vehicles(folder), vehicles(made))

  folder.test("a missing topic, SQLite, and a file that is not a bag are reported in a line"): folder =>
    def refused(bag: Path, topic: Option[String] = None) =
      BagLoop(topic.toSet, Set.empty).observed(bag).fold(identity, _ => "")
    assert(refused(made, Some("/x/odom")).startsWith("expected the topic /x/odom in "))
    val sqlite = Files.createDirectory(folder.resolve("sqlite"))
    Files.createFile(sqlite.resolve("bag_0.db3"))
    assert(refused(sqlite).contains("ros2 bag convert"))
    assert(refused(folder.resolve("absent")).contains("there is none"))
    val broken = Files.writeString(folder.resolve("broken.mcap"), "no MCAP")
    assert(refused(broken).startsWith(broken.toString), refused(broken))

  test("a topic's vehicle is the first part of its name"):
    assertEquals(
      Vector("/uav1/mavros/odom", "/uav1/cmd_vel", "/odom").map(TopicLoop.vehicleOf),
      Vector("uav1", "uav1", "")
    )
