package skein.mavlink

/** An autopilot's flight modes, with PX4's numbers of main and sub modes (`px4_custom_mode.h`). */
enum FlightMode(val main: Int, val sub: Int, val title: String):
  case Takeoff  extends FlightMode(4, 2, "Takeoff")
  case Hold     extends FlightMode(4, 3, "Hold")
  case Mission  extends FlightMode(4, 4, "Mission")
  case Return   extends FlightMode(4, 5, "Return")
  case Land     extends FlightMode(4, 6, "Land")
  case Offboard extends FlightMode(6, 0, "Offboard")

  def customMode: Long = FlightMode.customMode(main, sub)

object FlightMode:
  def customMode(main: Int, sub: Int): Long = main.toLong << 16 | sub.toLong << 24

  def of(main: Int, sub: Int): Option[FlightMode] =
    values.find(mode => mode.main == main && (mode.sub == sub || main == Offboard.main))

  def of(customMode: Long): Option[FlightMode] =
    of((customMode >> 16 & 0xff).toInt, (customMode >> 24 & 0xff).toInt)
