package skein.simulator

import skein.airsim.VehicleSettings

/** The simulation as the server's functions see it. */
private[simulator] trait Simulated:
  def settings: SimulatorSettings

  def world: World

  def isPaused: Boolean

  private[simulator] def setPaused(on: Boolean): Unit

  private[simulator] def addVehicle(vehicle: VehicleSettings): Unit

  private[simulator] def objects: SceneObjects

  private[simulator] def cameras: Cameras

  private[simulator] def equipment: SensorSettings

  /** Whether a client has started AirSim's own recording. Nothing is written: Skein's recordings are made by
    * the controller.
    */
  private[simulator] def recording: Boolean

  private[simulator] def recording_=(on: Boolean): Unit

  /** Adds a plan to a vehicle's buffer, in place of its move, if it has one. */
  private[simulator] def follow(vehicle: Int, sequence: Long, plan: Move.Plan): Unit

  /** Returns all vehicles to their starts and drops all moves, including queued ones. */
  private[simulator] def reset(): Unit
