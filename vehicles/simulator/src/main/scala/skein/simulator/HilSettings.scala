package skein.simulator

import skein.hil.{ArduPilotInterface, AutopilotKind, BetaflightInterface, Px4Interface, SensorNoise}
import skein.link.Address

/** Autopilots that fly the vehicles: the simulator gives them sensors and takes their rotors' controls.
  *
  * @param ports a vehicle's each, in their order; of PX4 by the simulator's own transport, which is TCP where
  *   that is real, of the others UDP. Vehicles without a port have no autopilot
  * @param stateTo where Betaflight takes its state
  * @param seed of the sensors' noise; each vehicle has its own
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

  /** At the ports at which these autopilots look for a simulator. Betaflight knows one vehicle alone. */
  def usual(autopilot: AutopilotKind, vehicles: Int, host: String = "127.0.0.1"): HilSettings =
    val ports = autopilot match
      case AutopilotKind.Px4        => Vector.tabulate(vehicles)(Px4Interface.Port + _)
      case AutopilotKind.ArduPilot  => Vector.tabulate(vehicles)(ArduPilotInterface.Port + 10 * _)
      case AutopilotKind.Betaflight => Vector(BetaflightInterface.Port)
    HilSettings(autopilot, ports.map(Address(host, _)))
