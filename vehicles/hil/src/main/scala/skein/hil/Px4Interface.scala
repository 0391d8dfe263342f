package skein.hil

import skein.mavlink.*
import skein.mavlink.CommonDialect.{Command, ModeFlag}
import skein.units.*
import skein.vehicle.{Airframe, Setpoint}

/** PX4's simulator interface (its `simulator_mavlink`; the simulator listens, PX4 connects by TCP):
  * HIL_SENSOR at 250 Hz, HIL_GPS at 8 Hz, SYSTEM_TIME once a second, and HIL_STATE_QUATERNION as often as PX4
  * requests. PX4's clock is the time of the first sensors; it answers each HIL_SENSOR with
  * HIL_ACTUATOR_CONTROLS and waits for the next.
  *
  * Until the first answer physics follows the clock, because PX4's start-up uses the sensors' time. From then
  * on, as long as the answers state lockstep, physics waits for the answer to the newest sensors, whose time
  * it carries. Sensors sent before the first answer are answered too, later; if each answer counted for the
  * newest sensors, PX4's controls would lag by all of these for the rest of the flight.
  *
  * A PX4 that is silent, or whose answers carry other times, is given up: it is not waited for until it has
  * answered in time for a second, and for longer each further time ([[Trust]]).
  *
  * @param system the system number of sent frames
  * @param before number of times that an autopilot of this vehicle was given up before
  */
final class Px4Interface(system: Int, sensors: Sensors, from: Span, before: Int = 0)
    extends AutopilotInterface:
  import Px4Interface.*

  private val reader        = FrameReader()
  private val writer        = FrameWriter(system, Component)
  private var controls      = AutopilotInterface.MotorsOff
  private var isLockstep    = false
  private var owes          = false
  private var sensedUsec    = 0L
  private val trust         = Trust(before)
  private var answeredUsec  = 0L // the newest time answered
  private var answeredAt    = 0L // tick
  private var catchesUp     = false
  private var postponed     = 0
  private var due           = Period * (from.toNanos / Period.toNanos + 1)
  private var ticks         = 0L
  private var magneticFrd   = Vector3.Zero
  private var pressure      = 0.0
  private var temperatureC  = 0.0
  private var fix           = Option.empty[Sensors.Fix]
  private var fixDue        = from + FirstFix
  private var systemTimeDue = from
  private var stateInterval = Option.empty[Span]
  private var stateDue      = from

  def hear(bytes: Array[Byte], up: Span): Vector[Array[Byte]] =
    for frame <- reader.read(bytes) do
      frame.message match
        case answer: HilActuatorControls =>
          isLockstep = (answer.flags & LockstepFlag) != 0
          val told     = answer.timeUsec
          val isAbsurd = told < 0 || told > sensedUsec + PeriodUsec
          if !isAbsurd then
            catchesUp ||= told < sensedUsec && told > answeredUsec
            answeredUsec = answeredUsec.max(told)
            if isLockstep && told >= sensedUsec - MostLateUsec && answeredAt != ticks then
              answeredAt = ticks
              trust.answered()
          owes = isLockstep && trust.isGiven && (owes && isAbsurd || !isAbsurd && told < sensedUsec)
          controls =
            if (answer.mode & ModeFlag.Armed) == 0 then AutopilotInterface.MotorsOff
            else AutopilotInterface.rotors(answer.controls.map(_.toDouble))
        case CommandLong(_, _, Command.SetMessageInterval, _, id, micros, _, _, _, _, _)
            if id == StateId && !micros.isNaN =>
          stateInterval =
            Option.unless(micros < 0)(Span.ofSeconds(micros.min(1e9f) * 1e-6).max(Period))
          stateDue = up
        case _ => ()
    Vector.empty

  def rotors: Setpoint        = controls
  def isWaiting: Boolean      = owes
  def isByClock: Boolean      = true
  def stop(until: Span): Span = due

  /** Stops waiting for the autopilot. For one that is catching up it keeps waiting, a limited number of
    * times.
    */
  def giveUp(): Unit =
    if catchesUp && postponed < MostPostponed then postponed += 1
    else
      trust.lose()
      owes = false
    catchesUp = false

  def losses: Int = trust.losses

  def damaged: Long = reader.counts.damaged

  def sense(truth: SensorTruth): Vector[Array[Byte]] =
    val messages =
      sensor(truth) +: (state(truth) ++ satellites(truth) ++ systemTime(truth)).toVector
    due = due + Period
    ticks += 1
    sensedUsec = micros(truth.up)
    postponed = 0
    if ticks - answeredAt > MostLateTicks then trust.missed()
    owes = isLockstep && trust.isGiven
    Vector(messages.flatMap(writer.write).toArray)

  private def sensor(truth: SensorTruth): Message =
    val inertial   = sensors.inertial(truth, Period.toSeconds)
    val isMagnetic = ticks % TicksPerSlowReading == 0
    val isPressure = ticks % TicksPerSlowReading == 2 || ticks == 0
    if isMagnetic then magneticFrd = sensors.magneticFrd(truth)
    if isPressure then
      pressure = sensors.pressurePa(truth)
      temperatureC = truth.temperatureK - 273.15
    val force = inertial.specificForceFrd
    val rates = inertial.angularVelocityFrd
    HilSensor(
      micros(truth.up),
      force.x.toFloat,
      force.y.toFloat,
      force.z.toFloat,
      rates.x.toFloat,
      rates.y.toFloat,
      rates.z.toFloat,
      magneticFrd.x.toFloat,
      magneticFrd.y.toFloat,
      magneticFrd.z.toFloat,
      (pressure / 100).toFloat,
      0,
      pressureAltitudeM(pressure).toFloat,
      temperatureC.toFloat,
      Updated.Inertial | (if isMagnetic then Updated.Magnetic else 0L) |
        (if isPressure then Updated.Pressure else 0L) |
        (if truth.jumped then Updated.Reset else 0L)
    )

  private def satellites(truth: SensorTruth): Option[Message] =
    if fix.isEmpty && truth.up >= fixDue then
      fix = Some(sensors.fix(truth))
      fixDue = fixDue + FixInterval
    val arrived = fix.filter(_.at + FixLatency <= truth.at)
    if arrived.nonEmpty then fix = None
    arrived.map(gps)

  private def gps(fix: Sensors.Fix): Message =
    val velocity = fix.velocityNed
    val speed    = StrictMath.hypot(velocity.x, velocity.y)
    val course   = math.toDegrees(StrictMath.atan2(velocity.y, velocity.x))
    HilGps(
      fix.at.toNanos / 1000,
      fixType = 3,
      degE7(fix.place.latitudeDeg),
      degE7(fix.place.longitudeDeg),
      math.round(fix.place.altitude.value * 1000).toInt,
      eph = 90,
      epv = 178,
      short(speed * 100),
      short(velocity.x * 100),
      short(velocity.y * 100),
      short(velocity.z * 100),
      (math.round(course * 100).toInt + 36000) % 36000,
      satellitesVisible = 10
    )

  private def state(truth: SensorTruth): Option[Message] =
    stateInterval.filter(_ => stateDue <= truth.up).map: interval =>
      // Late messages are not made up for.
      stateDue = if stateDue + interval > truth.up then stateDue + interval else truth.up + interval
      val seen         = truth.kinematics
      val turn         = seen.orientation
      val acceleration = truth.accelerationNed * (1000 / Airframe.Gravity)
      HilStateQuaternion(
        micros(truth.up),
        Vector(turn.w, turn.x, turn.y, turn.z).map(_.toFloat),
        seen.angularVelocityFrd.x.toFloat,
        seen.angularVelocityFrd.y.toFloat,
        seen.angularVelocityFrd.z.toFloat,
        degE7(truth.place.latitudeDeg),
        degE7(truth.place.longitudeDeg),
        math.round(truth.place.altitude.value * 1000).toInt,
        short(seen.velocityNed.x * 100),
        short(seen.velocityNed.y * 100),
        short(seen.velocityNed.z * 100),
        indAirspeed = 0,
        trueAirspeed = short(seen.velocityNed.norm * 100),
        short(acceleration.x),
        short(acceleration.y),
        short(acceleration.z)
      )

  private def systemTime(truth: SensorTruth): Option[Message] = Option.when(systemTimeDue <= truth.up):
    systemTimeDue = truth.up + SystemTimeInterval
    SystemTime(truth.at.toNanos / 1000, truth.up.toNanos / 1_000_000)

object Px4Interface:
  /** Interval of HIL_SENSOR messages. */
  val Period: Span = Span.ofMillis(4)

  /** The first vehicle's port; the port of each further vehicle is one higher. */
  val Port = 4560

  /** MAVLink's component number, as in PX4's plugin for Gazebo. */
  private val Component = 200

  private val LockstepFlag = 1L

  /** While physics does not wait, an answer later than this does not count as in time. */
  private val MostLateTicks = 25
  private val PeriodUsec    = Period.toNanos / 1000
  private val MostLateUsec  = MostLateTicks * PeriodUsec

  /** Maximum number of times that physics waits again for an autopilot that is catching up. */
  private val MostPostponed = 10

  private val StateId = 115

  /** Number of sensor messages for each reading of magnetometer and barometer: 50 Hz, as in AirSim. */
  private val TicksPerSlowReading = 5

  /** Interval of satellite fixes, as in PX4's simulated receiver. */
  private val FixInterval = Span.ofMillis(125)

  /** The latency that PX4's estimator assumes (`EKF2_GPS_DELAY`). */
  private val FixLatency = Span.ofMillis(110)

  /** Time of the first satellite fix, as in AirSim. */
  private val FirstFix = Span.ofSeconds(1)

  private val SystemTimeInterval = Span.ofSeconds(1)

  private object Updated:
    val Inertial = 0x3fL
    val Magnetic = 0x1c0L
    // Pressure, altitude by pressure, temperature.
    val Pressure = 0x1a00L
    // The vehicle was moved: estimators must restart.
    val Reset = 0x80000000L

  private def micros(up: Span): Long = up.toNanos / 1000

  private def degE7(degrees: Double): Int = math.round(degrees * 1e7).toInt

  private def short(value: Double): Int = math.round(value.max(-32767).min(32767)).toInt

  /** Altitude of a pressure, m, by the International Standard Atmosphere (ISO 2533). */
  private def pressureAltitudeM(pressurePa: Double): Double =
    288.15 / 0.0065 * (1 - StrictMath.pow(pressurePa / 101325, 0.190263))
