package skein.hil

import java.nio.{ByteBuffer, ByteOrder}
import skein.units.*
import skein.vehicle.Setpoint

/** The interface of Betaflight's SITL (its `fdm_packet` and `servo_packet`, 4.6): a datagram with the
  * vehicle's state every 2 ms, one with four rotors' controls back. Neither side waits for the other; late
  * data is dropped.
  *
  * Betaflight estimates its clock rate as the difference of two states' times over that of their arrivals,
  * which for two that arrive close together is a hundredfold too large (`updateState` in its `sitl.c`). Where
  * their times are equal, Betaflight keeps its rate, at first the real clock's. So all states carry one
  * constant time. At another speed than the real clock's, the rate is conveyed once, by two states far apart,
  * as soon as Betaflight has sent a message.
  *
  * Gyroscope, accelerometer and barometer have their errors; the attitude, which Betaflight takes from the
  * simulator, is the true one.
  *
  * @param speed rate of the simulator's clock relative to the real one
  */
final class BetaflightInterface(sensors: Sensors, from: Span, speed: Double = 1) extends AutopilotInterface:
  import AutopilotInterface.Step
  import BetaflightInterface.*

  private var controls = AutopilotInterface.MotorsOff
  private var due      = AutopilotInterface.onGrid(from) + Period
  private var sensed   = from
  private var notRead  = 0L

  private val silence  = Span.ofSeconds(SilenceS * speed)
  private val apart    = Span.ofMillis(math.max(1, math.min(ApartMs, (MostApartRealMs * speed).toInt)))
  private var heardAt  = Option.empty[Span]
  private var told     = Span.Zero
  private var rateDue  = false
  private var rateFrom = Option.empty[Span]

  def hear(bytes: Array[Byte], up: Span): Vector[Array[Byte]] =
    if !isPacket(bytes) then notRead += 1
    else
      val values = ByteBuffer.wrap(bytes).order(ByteOrder.LITTLE_ENDIAN)
      controls = AutopilotInterface.rotors(Vector.fill(4)(values.getFloat().toDouble))
      // It may have been restarted.
      if speed != 1 && heardAt.forall(before => up - before > silence) then rateDue = true
      heardAt = Some(up)
    Vector.empty

  def rotors: Setpoint        = controls
  def isWaiting: Boolean      = false
  def isByClock: Boolean      = true
  def stop(until: Span): Span = due.max(AutopilotInterface.onGrid(until))
  def giveUp(): Unit          = ()
  def losses: Int             = 0
  def damaged: Long           = notRead

  def sense(truth: SensorTruth): Vector[Array[Byte]] =
    due = truth.up + nextAfter(truth.up)
    val inertial = sensors.inertial(truth, (truth.up - sensed).max(Step).toSeconds)
    sensed = truth.up
    val force    = inertial.specificForceFrd
    val rates    = inertial.angularVelocityFrd
    val turn     = truth.kinematics.orientation
    val velocity = truth.kinematics.velocityNed
    val packet   = ByteBuffer.allocate(StateLength).order(ByteOrder.LITTLE_ENDIAN)
    packet.putDouble(told.toSeconds)
    put(packet, rates.x, rates.y, rates.z)
    // The measured values, with x to the front, y to the left and z up, and then negated.
    put(packet, -force.x, force.y, force.z)
    // Betaflight's own axes differ, but for the SITL it swaps the signs (`imuComputeRotationMatrix`).
    put(packet, turn.w, turn.x, turn.y, turn.z)
    put(packet, velocity.y, velocity.x, -velocity.z)
    put(packet, truth.place.longitudeDeg, truth.place.latitudeDeg, truth.place.altitude.value)
    put(packet, sensors.pressurePa(truth))
    Vector(packet.array)

  /** The time after `up` at which the next state is due, including states that convey the clock rate. */
  private def nextAfter(up: Span): Span =
    for first <- rateFrom do
      rateFrom = None
      if up - first < TooFarApart then
        told = told + (up - first)
        rateDue = false
    if rateDue then
      rateFrom = Some(up)
      apart
    else Period

  private def put(to: ByteBuffer, values: Double*): Unit = values.foreach(to.putDouble)

object BetaflightInterface:
  /** The port on the simulator's machine to which Betaflight sends the rotors' controls. */
  val Port = 9002

  /** The port on which Betaflight receives the state. */
  val StatePort = 9003

  private val Period = Span.ofMillis(2)

  /** Silence after which Betaflight counts as gone, s of real time. */
  private val SilenceS = 0.25

  /** Distance of the two states that convey the clock rate: the farther apart, the less their delay matters.
    */
  private val ApartMs = 15

  /** Betaflight derives no rate from states this far apart. */
  private val TooFarApart = Span.ofMillis(20)

  /** Maximum real time between these two states, ms: from half a second on, Betaflight derives no rate. */
  private val MostApartRealMs = 400

  private[hil] def isPacket(bytes: Array[Byte]): Boolean = bytes.length == ServoLength

  private val ServoLength = 4 * 4
  private val StateLength = 18 * 8
