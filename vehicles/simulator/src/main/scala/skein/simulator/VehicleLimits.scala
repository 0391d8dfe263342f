package skein.simulator

import skein.airsim.{VehicleSettings, WorldSettings}

/** Limits on the simulator's vehicles, from its settings and from clients that add some. */
private[simulator] object VehicleLimits:
  /** Maximum number of vehicles; clients cannot add more. */
  val MostVehicles = 256

  val LongestName = 100

  /** Maximum distance from the origin, m; beyond it numbers lose their precision. */
  val FarthestM = 1e6

  /** Maximum wind speed, m/s; beyond it physics' steps would be too long. */
  val FastestWindMps = 300.0

  val Types: Vector[String] =
    Vector(WorldSettings.SimpleFlight, WorldSettings.PhysXCar, WorldSettings.ComputerVision)

  /** Whether the vehicle's type is supported, ignoring case. */
  def flies(vehicle: VehicleSettings): Boolean = Types.exists(_.equalsIgnoreCase(vehicle.vehicleType))
