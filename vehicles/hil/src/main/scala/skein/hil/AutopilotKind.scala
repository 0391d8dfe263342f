package skein.hil

import skein.units.Span

/** Autopilots whose interface the simulator speaks. */
enum AutopilotKind(val label: String):
  /** PX4's simulator interface, MAVLink in lockstep. */
  case Px4 extends AutopilotKind("px4")

  /** ArduPilot's JSON interface. */
  case ArduPilot extends AutopilotKind("ardupilot")

  /** The interface of Betaflight's SITL. */
  case Betaflight extends AutopilotKind("betaflight")

  /** One vehicle's.
    *
    * @param system its number, from 1
    * @param from when it begins
    * @param speed of the simulator's clock against the real one
    */
  def interface(system: Int, sensors: Sensors, from: Span, speed: Double = 1): AutopilotInterface = this match
    case Px4        => Px4Interface(system, sensors, from)
    case ArduPilot  => ArduPilotInterface(sensors, from)
    case Betaflight => BetaflightInterface(sensors, from, speed)
