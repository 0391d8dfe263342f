package skein.simulator

import skein.hil.{ArduPilotInterface, AutopilotKind, BetaflightInterface, Px4Interface, SensorNoise}
import skein.link.Address

/** External autopilots that fly the vehicles: the simulator sends them sensor readings and applies their
  * rotor controls.
  *
  * @param ports one for each vehicle, in order. PX4's ports use the simulator's own transport, which is TCP
  *   outside tests, the others use UDP. Vehicles without a port have no autopilot
  * @param stateTo address at which Betaflight receives the state
  * @param seed seed of the sensors' noise; each vehicle has its own
  */
final case class HilSettings(
    autopilot: AutopilotKind,
    ports: Vector[Address],
    stateTo: Address = HilSettings.BetaflightState,
    noise: SensorNoise = SensorNoise(),
    seed: Long = 1
)

object HilSettings:
  private val BetaflightState = Address("127.0.0.1", BetaflightInterface.StatePort)

  /** The ports at which these autopilots look for a simulator. Betaflight supports only one vehicle. */
  def usual(autopilot: AutopilotKind, vehicles: Int, host: String = "127.0.0.1"): HilSettings =
    val ports = autopilot match
      case AutopilotKind.Px4        => Vector.tabulate(vehicles)(Px4Interface.Port + _)
      case AutopilotKind.ArduPilot  => Vector.tabulate(vehicles)(ArduPilotInterface.Port + 10 * _)
      case AutopilotKind.Betaflight => Vector(BetaflightInterface.Port)
    HilSettings(autopilot, ports.map(Address(host, _)))
