package skein.hil

import skein.mavlink.FrameReader
import skein.units.Span

/** Autopilots whose simulator interfaces are supported. */
enum AutopilotKind(val label: String):
  /** PX4's simulator interface, MAVLink in lockstep. */
  case Px4 extends AutopilotKind("px4")

  case ArduPilot extends AutopilotKind("ardupilot")

  /** The simulator interface of Betaflight's SITL. */
  case Betaflight extends AutopilotKind("betaflight")

  /** One vehicle's interface.
    *
    * @param system the vehicle's system number, from 1
    * @param from when the interface begins
    * @param speed rate of the simulator's clock relative to the real one
    * @param losses number of times that an autopilot of this vehicle was given up before
    */
  def interface(
      system: Int,
      sensors: Sensors,
      from: Span,
      speed: Double = 1,
      losses: Int = 0
  ): AutopilotInterface = this match
    case Px4        => Px4Interface(system, sensors, from, losses)
    case ArduPilot  => ArduPilotInterface(sensors, from, losses)
    case Betaflight => BetaflightInterface(sensors, from, speed)

  /** Whether a datagram, or a piece of a stream, contains one of its messages. */
  def speaks(bytes: Array[Byte]): Boolean = this match
    case Px4        => FrameReader.isSpoken(bytes)
    case ArduPilot  => ArduPilotInterface.isFrame(bytes)
    case Betaflight => BetaflightInterface.isPacket(bytes)
