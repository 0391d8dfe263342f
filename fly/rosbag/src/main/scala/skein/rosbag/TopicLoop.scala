package skein.rosbag

import java.nio.ByteOrder
import java.util.Locale
import skein.mcap.Bytes
import skein.observe.{NewCommands, ObservedTopics, Progress, SimulatedTime, TopicAccount, TopicKind}
import skein.units.Instant

/** Measures the loop of a graph of ROS 2 from messages of any types, as CDR, in the order in which they
  * arrived. Mutable; one thread at a time.
  *
  * If the graph has a `/clock`, all times are on it ([[GraphClock]]). Messages from before its first one, or
  * from before it went back, are counted and left out.
  *
  * @param readings topics with vehicles' readings; without any, those of poses whose name does not suggest
  *   commands
  * @param commands topics of commands; without any, those of twists and poses whose name suggests commands
  */
private[rosbag] final class TopicLoop(readings: Set[String], commands: Set[String]):
  import TopicLoop.*

  private val clock   = GraphClock()
  private var account = TopicAccount()
  private var before  = 0L

  /** The handler of a topic's messages; None if they are of no use.
    *
    * @param messageType such as `nav_msgs/msg/Odometry`
    * @param definition the text of the type's `.msg` file; empty if it is unknown
    */
  def topic(name: String, messageType: String, definition: => String): Option[Topic] =
    if name == "/clock" && messageType == "rosgraph_msgs/msg/Clock" then Some(tick)
    else kindOf(name, messageType).map(measured(_, name, beginsWithHeader(messageType, definition)))

  private def measured(kind: TopicKind, name: String, hasHeader: Boolean): Topic =
    val vehicle = vehicleOf(name)
    (message, at) =>
      // A stamp of zero was not filled in.
      val stamp = if hasHeader then firstTime(message).filter(_ > Instant.Epoch) else None
      val time  = clock.timeOf(at)
      kind match
        case TopicKind.Commands =>
          account.command(vehicle, name, stamp, time, stamp.exists(clock.mayShow(_, time)))
        case TopicKind.Readings => account.reading(vehicle, name, stamp, time)

  private def kindOf(name: String, messageType: String): Option[TopicKind] =
    val isPose    = Poses(messageType)
    val isCommand = soundsLikeCommand(name)
    if commands(name) || commands.isEmpty && isCommand && (isPose || Twists(messageType)) && !readings(name)
    then Some(TopicKind.Commands)
    else Option.when(readings(name) || readings.isEmpty && isPose && !isCommand)(TopicKind.Readings)

  private def tick(message: Bytes, at: Instant): Unit =
    for time <- firstTime(message) if clock.add(time, at) do
      before += account.messages
      account = TopicAccount()

  /** Topics that were chosen and are not among these. */
  def missing(among: String => Boolean): Vector[String] =
    (readings ++ commands).filterNot(among).toVector.sorted

  def progress: Progress = account.progress

  def takeNew(): Vector[NewCommands] = account.takeNew()

  def observed: ObservedTopics = account.observed.copy(simulated = clock.step.map(SimulatedTime(_, before)))

private[rosbag] object TopicLoop:
  /** Takes the first [[NeededBytes]] of a message, or more, and its time of arrival. */
  type Topic = (Bytes, Instant) => Unit

  /** Bytes of a message that are read: those that state its encoding, and a time. */
  val NeededBytes = 12

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

  /** Whether a type begins with a header: by its definition, or by its name if that is unknown. */
  private def beginsWithHeader(messageType: String, definition: String): Boolean =
    val first = definition.linesIterator.map(_.takeWhile(_ != '#').trim)
      .find(line => line.nonEmpty && !line.contains('='))
    val isOther = messageType.nonEmpty && messageType != "geometry_msgs/msg/Twist"
    first.fold(isOther)(_.matches("""(std_msgs/)?Header\s+\w+"""))

  /** The time that a message begins with, as a header and a clock do: seconds and nanoseconds, behind four
    * bytes that state the encoding.
    */
  private def firstTime(message: Bytes): Option[Instant] =
    val order =
      if message.size < NeededBytes || message(0) != 0 then None
      else
        message(1) match
          case 0 => Some(ByteOrder.BIG_ENDIAN)
          case 1 => Some(ByteOrder.LITTLE_ENDIAN)
          case _ => None
    order.map: bytes =>
      val numbers          = message.buffer.order(bytes)
      val (seconds, nanos) = (numbers.getInt(4), numbers.getInt(8) & 0xffffffffL)
      Instant.ofNanos(seconds * 1_000_000_000L + nanos)
