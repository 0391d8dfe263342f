package skein.hil

import java.nio.{ByteBuffer, ByteOrder}
import skein.units.*
import skein.vehicle.Setpoint

/** The interface of Betaflight's SITL (its `fdm_packet` and `servo_packet`, 4.6): a datagram with the vehicle's state every
  * 2 ms, one with four rotors' controls back. Nobody waits for the other, so what is late is left out, not made up for.
  *
  * Betaflight takes the rate of its clock from the difference of two states' times over that of when they come, which for
  * two that come close together is a hundredfold. Where its time does not pass, it keeps the real clock. So at the real
  * clock's speed all states are told of one time.
  *
  * Gyroscope, accelerometer and barometer have their errors; the attitude is the truth, which Betaflight takes from the
  * simulator.
  */
final class BetaflightInterface(sensors: Sensors, from: Span, speed: Double = 1) extends AutopilotInterface:
  import AutopilotInterface.Step
  import BetaflightInterface.*

  private var controls = AutopilotInterface.MotorsOff
  private var due      = AutopilotInterface.onGrid(from) + Period
  private var sensed   = from
  private var notRead  = 0L

  def hear(bytes: Array[Byte], up: Span): Vector[Array[Byte]] =
    if bytes.length != ServoLength then notRead += 1
    else
      val values = ByteBuffer.wrap(bytes).order(ByteOrder.LITTLE_ENDIAN)
      controls = AutopilotInterface.rotors(Vector.fill(4)(values.getFloat().toDouble))
    Vector.empty

  def rotors: Setpoint        = controls
  def isWaiting: Boolean      = false
  def isByClock: Boolean      = true
  def stop(until: Span): Span = due.max(AutopilotInterface.onGrid(until))
  def giveUp(): Unit          = ()
  def damaged: Long           = notRead

  def sense(truth: SensorTruth): Vector[Array[Byte]] =
    val inertial = sensors.inertial(truth, (truth.up - sensed).max(Step).toSeconds)
    val force    = inertial.specificForceFrd
    val rates    = inertial.angularVelocityFrd
    val turn     = truth.kinematics.orientation
    val velocity = truth.kinematics.velocityNed
    val packet   = ByteBuffer.allocate(StateLength).order(ByteOrder.LITTLE_ENDIAN)
    packet.putDouble(if speed == 1 then 0 else truth.up.toSeconds)
    put(packet, rates.x, rates.y, rates.z)
    // What it measures, with x to the front, y to the left and z up, and then the sign turned.
    put(packet, -force.x, force.y, force.z)
    // Of that body in a world with x to the north, y to the west and z up.
    put(packet, turn.w, turn.x, -turn.y, -turn.z)
    put(packet, velocity.y, velocity.x, -velocity.z)
    put(packet, truth.place.longitudeDeg, truth.place.latitudeDeg, truth.place.altitude.value)
    put(packet, sensors.pressurePa(truth))
    sensed = truth.up
    due = truth.up + Period
    Vector(packet.array)

  private def put(to: ByteBuffer, values: Double*): Unit = values.foreach(to.putDouble)

object BetaflightInterface:
  /** Where it sends the rotors' controls, on the simulator's machine. */
  val Port = 9002

  /** Where it takes the state. */
  val StatePort = 9003

  private val Period = Span.ofMillis(2)

  private val ServoLength = 4 * 4
  private val StateLength = 18 * 8
