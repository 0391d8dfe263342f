package skein.simulator

import skein.airsim.{VehicleSettings, WorldSettings}

/** Which vehicles the built-in simulator has, by its settings and by clients that add some. */
private[simulator] object VehicleLimits:
  /** Clients can add until then. */
  val MostVehicles = 256

  /** Letters of a name. */
  val LongestName = 100

  /** From the origin; beyond it numbers would soon be none. */
  val FarthestM = 1e6

  val Types: Vector[String] =
    Vector(WorldSettings.SimpleFlight, WorldSettings.PhysXCar, WorldSettings.ComputerVision)

  /** Whether its type is one of these, in any case of letters. */
  def flies(vehicle: VehicleSettings): Boolean = Types.exists(_.equalsIgnoreCase(vehicle.vehicleType))
