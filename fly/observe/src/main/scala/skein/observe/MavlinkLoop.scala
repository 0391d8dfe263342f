package skein.observe

import org.apache.pekko.util.ByteString
import scala.collection.mutable
import skein.mavlink.*
import skein.units.Instant

/** Analyses a loop from frames of MAVLink 2 between a program and its vehicles. A vehicle is a system, read
  * by the messages of its autopilot (component 1). The vehicles' side of a connection is the one that sends
  * no commands.
  *
  * Readings are LOCAL_POSITION_NED, GLOBAL_POSITION_INT and ODOMETRY; commands are
  * SET_POSITION_TARGET_LOCAL_NED, SET_POSITION_TARGET_GLOBAL_INT and SET_ATTITUDE_TARGET. A command is
  * assumed to be based on the newest reading of each vehicle that passed before it ([[TopicAccount]]).
  * Readings are stamped on the vehicle's clock since boot, which the TIMESYNCs between the two sides relate
  * to ours.
  *
  * Memory: [[MavlinkLoop.MostConnections]] connections, [[MavlinkLoop.MostPending]] unanswered TIMESYNCs, and
  * that of [[TopicAccount]].
  *
  * @param isDatagrams whether each piece is a datagram
  * @param readings MAVLink names of the messages that count as readings; without any, those above
  */
final class MavlinkLoop(isDatagrams: Boolean, readings: Set[String] = Set.empty)
    extends Analysis[ObservedTopics]:
  import MavlinkLoop.*

  private val account = TopicAccount()
  private val readers = mutable.HashMap.empty[Side, FrameReader]
  private val pending = mutable.LinkedHashMap.empty[Long, (side: Side, at: Instant)]
  private val heeded  = if readings.isEmpty then Positions else readings
  private val known   = mutable.LinkedHashSet.empty[Int]

  /** Sides of connections that sent a command, which are the program's sides. */
  private val programs = mutable.HashSet.empty[Side]

  private var counts = ReaderCounts()
  private var over   = 0L

  def opened(connection: Int, at: Instant): Unit =
    if readers.size < 2 * MostConnections then
      for isFromClient <- Seq(true, false) do readers((connection, isFromClient)) = FrameReader()

  def passed(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant): Unit =
    readers.get((connection, isFromClient)) match
      case None         => over += 1
      case Some(reader) =>
        val piece  = bytes.toArrayUnsafe()
        val frames = if isDatagrams then reader.readDatagram(piece) else reader.read(piece)
        frames.foreach(passed(_, (connection, isFromClient), at))

  private def passed(frame: Frame, side: Side, at: Instant): Unit = frame.message match
    case Timesync(0, ours, _, _) =>
      pending(ours) = (side, at)
      if pending.size > MostPending then pending -= pending.head._1
    case Timesync(theirs, ours, _, _) =>
      for
        (asker, sentAt) <- pending.get(ours)
        if asker != side && isVehicles(frame, side) && known(frame.system)
      do
        account.exchanged(vehicle(frame.system), sentAt, Instant.ofNanos(theirs), at)
    case command: SetPositionTargetLocalNed =>
      commanded("SET_POSITION_TARGET_LOCAL_NED", command.targetSystem, side, at)
    case command: SetPositionTargetGlobalInt =>
      commanded("SET_POSITION_TARGET_GLOBAL_INT", command.targetSystem, side, at)
    case command: SetAttitudeTarget => commanded("SET_ATTITUDE_TARGET", command.targetSystem, side, at)
    case message                    =>
      for reading <- reading(message) if heeded(reading.name) && isVehicles(frame, side) do
        known += frame.system
        account.reading(
          vehicle(frame.system),
          s"${reading.name} of ${frame.system}",
          Some(reading.stamp),
          at
        )

  /** Whether a frame is a vehicle's own, and not of an additional program on it, for example for vision. */
  private def isVehicles(frame: Frame, side: Side) = frame.component == Autopilot && !programs(side)

  /** Adds a command; one to system 0 is to all. */
  private def commanded(name: String, target: Int, side: Side, at: Instant): Unit =
    programs += side
    for system <- if target == 0 then known.toVector else Vector(target) do
      account.command(vehicle(system), s"$name to $system", None, at)

  def closed(connection: Int, at: Instant): Unit =
    for isFromClient <- Seq(true, false); reader <- readers.remove((connection, isFromClient)) do
      programs -= ((connection, isFromClient))
      counts = sum(counts, reader.counts)

  def passedOver(count: Long): Unit = over += count

  export account.{progress, takeNew}

  def observed: ObservedTopics =
    val before = account.observed
    before.copy(notKept = before.notKept + over)

  /** Counts of what could not be analysed, each as a sentence for a person. */
  def remarks: Vector[String] =
    val all    = readers.valuesIterator.map(_.counts).foldLeft(counts)(sum)
    val silent = Option.when(known.isEmpty):
      "No vehicle was heard: is it at that address, and does it send its position by MAVLink 2?"
    silent.toVector ++ Vector(
      all.version1 -> "frames were of MAVLink 1, which is not analysed: expected MAVLink 2",
      all.badChecksum + all.notUnderstood -> "frames were damaged",
      all.garbageBytes                    -> "bytes were no frames"
    ).collect { case (count, what) if count > 0 => s"$count $what." }

object MavlinkLoop:
  private type Side = (connection: Int, isFromClient: Boolean)

  /** MAV_COMP_ID_AUTOPILOT1 of the common dialect: the component that flies the vehicle. */
  private val Autopilot = 1

  val MostConnections = 256
  val MostPending     = 256

  private val Positions = Set("LOCAL_POSITION_NED", "GLOBAL_POSITION_INT", "ODOMETRY")

  /** Names of the messages by which vehicles can be read. */
  val Readings: Vector[String] = Positions.toVector.sorted ++ Vector("ATTITUDE", "ATTITUDE_QUATERNION")

  private def vehicle(system: Int) = s"system $system"

  private def reading(message: Message): Option[(name: String, stamp: Instant)] =
    def stamped(name: String, bootMs: Long) = Some((name, Instant.ofNanos(bootMs * 1_000_000)))
    message match
      case local: LocalPositionNed      => stamped("LOCAL_POSITION_NED", local.timeBootMs)
      case global: GlobalPositionInt    => stamped("GLOBAL_POSITION_INT", global.timeBootMs)
      case attitude: Attitude           => stamped("ATTITUDE", attitude.timeBootMs)
      case attitude: AttitudeQuaternion => stamped("ATTITUDE_QUATERNION", attitude.timeBootMs)
      case odometry: Odometry           => Some(("ODOMETRY", Instant.ofNanos(odometry.timeUsec * 1000)))
      case _                            => None

  private def sum(one: ReaderCounts, other: ReaderCounts) = ReaderCounts(
    badChecksum = one.badChecksum + other.badChecksum,
    notUnderstood = one.notUnderstood + other.notUnderstood,
    version1 = one.version1 + other.version1,
    garbageBytes = one.garbageBytes + other.garbageBytes
  )
