package skein.rosbag

import java.io.IOException
import java.nio.ByteOrder
import java.nio.file.{Files, Path}
import java.util.Locale
import scala.collection.mutable
import scala.jdk.StreamConverters.StreamHasToScala
import scala.util.Using
import skein.mcap.file.McapFile
import skein.mcap.{Bytes, Record, TopicMessage}
import skein.observe.{ObservedTopics, TopicAccount, TopicKind}
import skein.record.FileReason
import skein.units.{Expect, Instant}

/** Measures the loop that a bag of ROS 2 holds, from MCAP files, of any message types.
  *
  * @param readings topics that vehicles are read by; without any, those of poses whose name sounds like no
  *   command
  * @param commands topics of commands; without any, those of twists and poses whose name sounds like one
  */
final class BagLoop(readings: Set[String], commands: Set[String]):
  import BagLoop.*

  /** Reads a bag: its folder, or an MCAP file.
    *
    * @return Left states in a line what is no bag, or which topic is missing
    */
  def observed(bag: Path): Either[String, ObservedTopics] =
    val account = TopicAccount()
    for
      files <- mcapFiles(bag)
      seen  <- Expect.each(files)(add(_, account)).map(_.flatten.toSet)
      _     <- (readings ++ commands).find(!seen(_)).toLeft(()).left.map: missing =>
        s"expected the topic $missing in $bag, it has ${
            if seen.isEmpty then "none" else seen.toVector.sorted.mkString(", ")
          }"
    yield account.observed

  /** Adds the messages of a file.
    *
    * @return the names of its topics
    */
  private def add(file: Path, account: TopicAccount): Either[String, Iterable[String]] =
    val topics = mutable.Map.empty[Int, Topic]
    try
      McapFile.read(file): messages =>
        val failed = messages
          .flatMap:
            case Left(error)    => Some(s"$file: ${error.message}")
            case Right(message) =>
              val topic = topics.getOrElseUpdate(message.channel.id, Topic(message))
              topic.add(message.message, account)
              None
          .nextOption()
        failed.toLeft(topics.values.map(_.name))
    catch case failed: IOException => Left(s"cannot read $file: ${FileReason.of(failed)}")

  /** A topic, by its first message: what it is for the loop, of which vehicle, and whether its messages begin
    * with a header.
    */
  private final class Topic(first: TopicMessage):
    val name: String      = first.channel.topic
    private val vehicle   = vehicleOf(name)
    private val hasHeader = first.schema.exists(beginsWithHeader)
    private val kind      =
      val schema    = first.schema.fold("")(_.name)
      val isPose    = Poses(schema)
      val isCommand = soundsLikeCommand(name)
      if commands(name) || commands.isEmpty && isCommand && (isPose || Twists(schema)) && !readings(name) then
        Some(TopicKind.Commands)
      else Option.when(readings(name) || readings.isEmpty && isPose && !isCommand)(TopicKind.Readings)

    def add(message: Record.Message, account: TopicAccount): Unit =
      val at    = Instant.ofNanos(message.logTime)
      val stamp = Option.when(hasHeader)(message.data).filter(_.size >= StampEnd).flatMap(headerStamp)
      kind.foreach:
        case TopicKind.Commands => account.command(vehicle, name, stamp, at)
        case TopicKind.Readings => account.reading(vehicle, name, stamp, at)

object BagLoop:
  private val Poses = Set("Odometry", "PoseStamped", "PoseWithCovarianceStamped").map: name =>
    s"${if name == "Odometry" then "nav_msgs" else "geometry_msgs"}/msg/$name"

  private val Twists = Set("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")

  private def soundsLikeCommand(topic: String): Boolean =
    val name = topic.drop(topic.lastIndexOf('/') + 1).toLowerCase(Locale.ROOT)
    val path = topic.toLowerCase(Locale.ROOT)
    Vector("cmd", "command", "target", "goal").exists(name.contains) || path.contains("setpoint")

  /** The vehicle of a topic: its first part, if there are several. */
  private[rosbag] def vehicleOf(topic: String): String = topic.split('/').filter(_.nonEmpty) match
    case Array(first, _, _*) => first
    case _                   => ""

  private def mcapFiles(bag: Path): Either[String, Vector[Path]] =
    if Files.isRegularFile(bag) then Right(Vector(bag))
    else if !Files.isDirectory(bag) then Left(s"$bag: expected a bag's folder or an MCAP file, there is none")
    else
      val files = Using.resource(Files.list(bag))(_.toScala(Vector)).sorted
      val mcap  = files.filter(_.toString.endsWith(".mcap"))
      Either.cond(
        mcap.nonEmpty,
        mcap,
        if files.exists(_.toString.endsWith(".db3")) then
          s"$bag: expected MCAP, came SQLite; `ros2 bag convert` makes the one from the other"
        else s"$bag: expected a bag's folder, it has no MCAP file"
      )

  /** Whether a type begins with a header: by its definition, or by its name where the bag has none. */
  private def beginsWithHeader(schema: Record.Schema): Boolean =
    val first = schema.data.utf8.linesIterator.map(_.takeWhile(_ != '#').trim)
      .find(line => line.nonEmpty && !line.contains('='))
    first.fold(schema.name != "geometry_msgs/msg/Twist")(_.matches("""(std_msgs/)?Header\s+\w+"""))

  /** The first field of a header in CDR: seconds and nanoseconds, behind four bytes that state the encoding.
    */
  private def headerStamp(data: Bytes): Option[Instant] =
    val order = data(1) match
      case 0 => Some(ByteOrder.BIG_ENDIAN)
      case 1 => Some(ByteOrder.LITTLE_ENDIAN)
      case _ => None
    order.filter(_ => data(0) == 0).map: bytes =>
      val numbers          = data.buffer.order(bytes)
      val (seconds, nanos) = (numbers.getInt(4), numbers.getInt(8) & 0xffffffffL)
      Instant.ofNanos(seconds * 1_000_000_000L + nanos)

  private val StampEnd = 12
