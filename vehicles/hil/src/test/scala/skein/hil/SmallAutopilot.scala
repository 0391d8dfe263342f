package skein.hil

import skein.mavlink.*
import skein.units.*

/** The other side of PX4's simulator interface: an autopilot that only uses its sensors, arms once it knows
  * its position, climbs to its goal and stays there. It answers every HIL_SENSOR once.
  *
  * @param asksForState whether it requests the true state, as PX4 does
  */
final class SmallAutopilot(
    goalNed: Vector3 = Vector3(0, 0, -5),
    isLockstep: Boolean = true,
    asksForState: Boolean = true
):
  private val reader     = FrameReader()
  private val writer     = FrameWriter(1, 1)
  private val controller = SmallController()
  private var lastUsec   = 0L

  val estimator: SmallEstimator = SmallEstimator()

  /** Times in all received HIL_SENSOR messages. */
  var heard: Vector[Long] = Vector.empty

  /** The newest received true state of the vehicle. */
  var state: Option[HilStateQuaternion] = None

  var isArmed = false

  /** Number of received messages by kind. */
  var counts: Map[String, Int] = Map.empty

  /** Its first messages on a connection. */
  def greeting: Array[Byte] =
    val state = CommandLong(0, 0, CommonDialect.Command.SetMessageInterval, 0, 115, 5000, 0, 0, 0, 0, 0)
    writer.write(Heartbeat(0, 12, 0, 0, 0, 3)) ++ (if asksForState then writer.write(state)
                                                   else Array.empty[Byte])

  /** Its answer to received bytes. */
  def hear(bytes: Array[Byte]): Array[Byte] =
    reader.read(bytes).flatMap(frame => answer(frame.message)).flatMap(writer.write).toArray

  private def answer(message: Message): Option[Message] =
    val name = Dialect.of(message).name
    counts = counts.updated(name, counts.getOrElse(name, 0) + 1)
    message match
      case sensors: HilSensor =>
        heard = heard :+ sensors.timeUsec
        Some(controls(sensors))
      case gps: HilGps =>
        estimator.fix(
          GeoLocation(gps.lat * 1e-7, gps.lon * 1e-7, Metres(gps.alt * 1e-3)),
          Vector3(gps.vn, gps.ve, gps.vd) * 0.01
        )
        None
      case truth: HilStateQuaternion =>
        state = Some(truth)
        None
      case _ => None

  private def controls(sensors: HilSensor): Message =
    val dtS = if lastUsec == 0 then 0.004 else (sensors.timeUsec - lastUsec) * 1e-6
    lastUsec = sensors.timeUsec
    estimator.inertial(
      Vector3(sensors.xacc.toDouble, sensors.yacc.toDouble, sensors.zacc.toDouble),
      Vector3(sensors.xgyro.toDouble, sensors.ygyro.toDouble, sensors.zgyro.toDouble),
      dtS
    )
    if (sensors.fieldsUpdated & 0x1c0) != 0 then
      estimator.magnetic(Vector3(sensors.xmag.toDouble, sensors.ymag.toDouble, sensors.zmag.toDouble))
    if (sensors.fieldsUpdated & 0x800) != 0 then estimator.altitude(sensors.pressureAlt.toDouble)
    isArmed = isArmed || estimator.isReady
    val rotors =
      if !isArmed then Vector.empty
      else
        import estimator.*
        controller.rotors(goalNed, positionNed, velocityNed, orientation, angularVelocityFrd, dtS)
    HilActuatorControls(
      sensors.timeUsec,
      rotors.map(_.toFloat),
      if isArmed then 129 else 1,
      if isLockstep then 1 else 0
    )
