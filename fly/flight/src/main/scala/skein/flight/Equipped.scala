package skein.flight

import scala.concurrent.Future
import skein.airsim.{LidarSensor, Scan, VehicleClient}
import skein.port.{CommandPlan, Sensor, VehicleError, VehiclePort}
import skein.scenario.{Equipment, Scenario}
import skein.signal.Stamped

/** A vehicle with sensors in addition to its own. */
private[skein] final class Equipped(vehicle: VehiclePort, more: Map[String, Sensor]) extends VehiclePort:
  export vehicle.{act, hover, read}
  override def follow(plan: CommandPlan): Future[Either[VehicleError, Boolean]] = vehicle.follow(plan)
  override val sensors: Map[String, Sensor]                                     = vehicle.sensors ++ more

private[skein] object Equipped:

  /** A vehicle with its equipment in a scenario.
    *
    * @param seen sensors from its cameras, keyed by name
    * @param scanned called with each scan of a lidar, with its name
    */
  def by(
      scenario: Scenario,
      vehicle: VehiclePort,
      client: VehicleClient,
      seen: Map[String, Sensor] = Map.empty,
      scanned: (String, Stamped[Scan]) => Unit = (_, _) => ()
  ): VehiclePort =
    val lidars = scenario.equipment.collect:
      case lidar: Equipment.Lidar if lidar.vehicle == client.name =>
        lidar.name -> LidarSensor(client.eyes, lidar, scanned(lidar.name, _))
    if lidars.isEmpty && seen.isEmpty then vehicle else Equipped(vehicle, lidars.toMap ++ seen)
