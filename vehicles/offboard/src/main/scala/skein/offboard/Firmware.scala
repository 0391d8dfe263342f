package skein.offboard

import skein.mavlink.CommonDialect.ModeFlag
import skein.mavlink.FlightMode

/** An autopilot's firmware with its mode numbers.
  *
  * @param offboard the mode in which it follows setpoints, as in its heartbeat
  * @param holding the mode in which it stays in place
  * @param flyable modes from which it is switched to `offboard`: a pilot or a failsafe that switches to any
  *   other mode keeps control
  * @param takeoffM height of a takeoff; NaN: the autopilot's own
  */
enum Firmware(
    val title: String,
    val offboard: Long,
    val holding: Long,
    val flyable: Set[Long],
    val takeoffM: Float
):
  case Px4
      extends Firmware(
        "PX4",
        FlightMode.Offboard.customMode,
        FlightMode.Hold.customMode,
        Set(FlightMode.Offboard, FlightMode.Takeoff, FlightMode.Hold).map(_.customMode),
        Float.NaN
      )

  /** ArduPilot's copter (`mode.h`), which takes off in Guided and follows setpoints there. Not tested against
    * a real one.
    */
  case Copter extends Firmware("ArduPilot", 4, 17, Set(4, 17), 2.5f)

  def modeName(mode: Long): String = this match
    case Px4    => FlightMode.of(mode).fold(s"mode ${mode >> 16 & 0xff}.${mode >> 24 & 0xff}")(_.title)
    case Copter => Firmware.copterModes.getOrElse(mode, s"mode $mode")

  /** Parameters of the command that sets this mode. */
  def modeNumbers(mode: Long): Vector[Float] =
    val (main, sub) = this match
      case Px4    => (mode >> 16 & 0xff, mode >> 24 & 0xff)
      case Copter => (mode, 0L)
    Vector(ModeFlag.Custom.toFloat, main.toFloat, sub.toFloat, 0f, 0f, 0f, 0f)

object Firmware:
  /** Recognises the firmware of a heartbeat.
    *
    * @param autopilot `MAV_AUTOPILOT`
    * @param kind `MAV_TYPE`
    * @return Left says what was expected
    */
  def of(autopilot: Int, kind: Int): Either[String, Firmware] = (autopilot, kind) match
    case (12, _)                         => Right(Px4)
    case (3, copter) if isCopter(copter) => Right(Copter)
    case (3, other)                      =>
      Left(s"expected a multirotor of ArduPilot's, got a vehicle of type $other, whose modes are not known")
    case (other, _) =>
      Left(s"expected PX4 (12) or ArduPilot (3), got autopilot $other, whose modes are not known")

  /** Coaxial, helicopter, and multirotors of three to twelve rotors (`MAV_TYPE`). */
  private val isCopter = Set(2, 3, 4, 13, 14, 15, 29, 35)

  /** Mode names of ArduPilot's copter by `Mode::Number`, 4.6. */
  private[offboard] val copterModes: Map[Long, String] = Map(
    0L  -> "Stabilize",
    1L  -> "Acro",
    2L  -> "AltHold",
    3L  -> "Auto",
    4L  -> "Guided",
    5L  -> "Loiter",
    6L  -> "RTL",
    7L  -> "Circle",
    9L  -> "Land",
    11L -> "Drift",
    13L -> "Sport",
    14L -> "Flip",
    15L -> "AutoTune",
    16L -> "PosHold",
    17L -> "Brake",
    18L -> "Throw",
    19L -> "Avoid_ADSB",
    20L -> "Guided_NoGPS",
    21L -> "Smart_RTL",
    22L -> "FlowHold",
    23L -> "Follow",
    24L -> "ZigZag",
    25L -> "SystemID",
    26L -> "AutoRotate",
    27L -> "Auto_RTL",
    28L -> "Turtle"
  )
