package skein.simulator

import skein.airsim.VehicleSettings

/** What functions of the simulator's server act upon. */
private[simulator] trait Simulated:
  def settings: SimulatorSettings

  def world: World

  def isPaused: Boolean

  private[simulator] def setPaused(on: Boolean): Unit

  private[simulator] def addVehicle(vehicle: VehicleSettings): Unit

  private[simulator] def objects: SceneObjects

  private[simulator] def cameras: Cameras

  private[simulator] def equipment: SensorSettings

  /** Whether a client has asked for AirSim's own recording. Nothing is written: Skein's recordings are the
    * controller's.
    */
  private[simulator] def recording: Boolean

  private[simulator] def recording_=(on: Boolean): Unit

  /** Where voxel grids are written, if they are. */
  private[simulator] def grids: Option[GridFolder]

  /** All vehicles back to their starts; no move goes on, and none waits. */
  private[simulator] def reset(): Unit
