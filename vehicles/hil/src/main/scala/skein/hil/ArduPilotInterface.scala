package skein.hil

import java.nio.charset.StandardCharsets.US_ASCII
import java.nio.{ByteBuffer, ByteOrder}
import skein.units.*
import skein.vehicle.Setpoint

/** ArduPilot's JSON interface to simulators (its `SIM_JSON`): a datagram with the servos' pulses arrives,
  * physics advances by one frame, and a line with the state is returned. So ArduPilot sets the pace. It
  * receives the true state and adds its sensors' errors itself; the inertial sensors also have those of
  * [[Sensors]].
  *
  * A frame lasts as long as ArduPilot states, in whole milliseconds. A repeated frame, whose answer was lost,
  * gets identical bytes again. While ArduPilot is given up, physics follows the clock, and every request is
  * answered with the current state.
  *
  * @param before number of times that an autopilot of this vehicle was given up before
  */
final class ArduPilotInterface(sensors: Sensors, from: Span, before: Int = 0) extends AutopilotInterface:
  import ArduPilotInterface.*
  import AutopilotInterface.Step

  private var controls = AutopilotInterface.MotorsOff
  private var hasToAsk = true
  private var frame    = -1L
  private var due      = from
  private var answered = Vector.empty[Array[Byte]]
  private var sensed   = from
  private var notRead  = 0L
  private val trust    = Trust(before)
  private var heardAt  = from

  def hear(bytes: Array[Byte], up: Span): Vector[Array[Byte]] =
    val from = ByteBuffer.wrap(bytes).order(ByteOrder.LITTLE_ENDIAN)
    if !isFrame(bytes) then
      notRead += 1
      Vector.empty
    else
      from.getShort(): Unit
      val rate  = from.getShort() & 0xffff
      val count = from.getInt() & 0xffffffffL
      if count == frame then if hasToAsk then answered else Vector.empty
      else
        frame = count
        if up - heardAt > LongestFrame * 5 then trust.missed()
        heardAt = up
        trust.answered()
        controls = AutopilotInterface.rotors(
          Vector.fill(4)(((from.getShort() & 0xffff) - LeastPulse) / (MostPulse - LeastPulse))
        )
        if hasToAsk then
          val asked = Span.ofSeconds(1.0 / rate.max(1)).min(LongestFrame)
          due = AutopilotInterface.onGrid(up) + Step * math.round(asked.toSeconds / Step.toSeconds).max(1)
          hasToAsk = false
        Vector.empty

  def rotors: Setpoint   = controls
  def isWaiting: Boolean = hasToAsk && trust.isGiven
  def isByClock: Boolean = !trust.isGiven
  def losses: Int        = trust.losses

  /** Without a request no state is due. */
  def stop(until: Span): Span = if hasToAsk then until + LongestFrame else due
  def damaged: Long           = notRead

  def giveUp(): Unit = trust.lose()

  def sense(truth: SensorTruth): Vector[Array[Byte]] =
    val inertial = sensors.inertial(truth, (truth.up - sensed).max(Step).toSeconds)
    val seen     = truth.kinematics
    val turn     = seen.orientation
    val line     =
      s"""\n{"timestamp":${truth.up.toSeconds},"imu":{"gyro":${list(inertial.angularVelocityFrd)},""" +
        s""""accel_body":${list(inertial.specificForceFrd)}},"position":${list(seen.positionNed)},""" +
        s""""attitude":[${turn.rollRad},${turn.pitchRad},${turn.yawRad}],""" +
        s""""quaternion":[${turn.w},${turn.x},${turn.y},${turn.z}],"velocity":${list(seen.velocityNed)}}\n"""
    sensed = truth.up
    hasToAsk = true
    answered = Vector(line.getBytes(US_ASCII))
    answered

object ArduPilotInterface:
  /** The first vehicle's port; the port of each further vehicle is ten higher. */
  val Port = 9002

  /** Whether a datagram is one of ArduPilot's frames. */
  private[hil] def isFrame(bytes: Array[Byte]): Boolean =
    bytes.length >= HeaderLength && {
      val magic = (bytes(0) & 0xff) | (bytes(1) & 0xff) << 8
      ServosByMagic.get(magic).exists(servos => bytes.length == HeaderLength + 2 * servos)
    }

  private val HeaderLength = 8

  /** Number of servos by the frame's magic number. */
  private val ServosByMagic = Map(18458 -> 16, 29569 -> 32)

  /** Pulses of a rotor at rest and at full speed, µs. */
  private val LeastPulse = 1000.0
  private val MostPulse  = 2000.0

  private val LongestFrame = Span.ofMillis(20)

  private def list(v: Vector3): String = s"[${v.x},${v.y},${v.z}]"
