package skein.airsim

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.policy.Agent
import skein.port.VehiclePort
import skein.vehicle.VehicleKind

/** Makes clients and ports of a simulator's vehicles, by kind. */
object Vehicles:

  /** The vehicle of this name; its origin is read from the simulator's settings. */
  def named(
      client: AirSimClient,
      name: String,
      kind: VehicleKind
  ): Future[Either[AirSimError, VehicleClient]] = kind match
    case VehicleKind.Multirotor => Multirotor.named(client, name)
    case VehicleKind.Car        => Car.named(client, name)

  /** A vehicle's port for a loop.
    *
    * @param onLost called with one line for each missed answer: what happened to it
    */
  def port(vehicle: VehicleClient, onLost: String => Unit)(using ActorSystem): VehiclePort = vehicle match
    case multirotor: Multirotor => AirSimVehicle(multirotor, onLost)
    case car: Car               => AirSimCar(car)

  /** Settings of a scenario's agent: on the ground below its start, heading towards its goal. */
  def settings(agent: Agent): VehicleSettings =
    val vehicleType = agent.kind match
      case VehicleKind.Multirotor => WorldSettings.SimpleFlight
      case VehicleKind.Car        => WorldSettings.PhysXCar
    VehicleSettings(
      agent.name,
      agent.startPositionNed.copy(z = 0),
      agent.startHeading,
      vehicleType,
      sensors = WorldSettings.usualSensors(vehicleType)
    )
