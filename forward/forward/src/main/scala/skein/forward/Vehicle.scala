package skein.forward

import skein.policy.Action
import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{QuadrotorModel, SensorNoise, VehicleModel}

/** One vehicle of a rollout. Mutable; one per vehicle and thread. */
trait Vehicle:
  /** Resets the vehicle to rest at this position at time 0; world NED, m. */
  def start(x: Double, y: Double, z: Double): Unit

  /** Receives a command now: a horizontal velocity at the altitude of the start, or another action that the
    * vehicle [[VelocityResponse.performs performs]]. It takes effect after the vehicle's dead time, and lasts
    * until the next one does.
    */
  def act(action: Action): Unit

  /** Simulates until this time, s; times must not decrease. */
  def advance(timeS: Double): Unit

  def x: Double

  def y: Double

  def z: Double

  def vx: Double

  def vy: Double

  // Position and velocity as readings report them.
  def seenX: Double  = x
  def seenY: Double  = y
  def seenZ: Double  = z
  def seenVx: Double = vx
  def seenVy: Double = vy

  /** The vehicle's reading. A model of horizontal motion reports a level attitude, no rotation and z = 0. */
  def seen: Kinematics = level(0)

  protected def level(downM: Double): Kinematics =
    Kinematics(Vector3(seenX, seenY, downM), Vector3(seenVx, seenVy, 0), Quaternion.Identity, Vector3.Zero)

/** How a kind of vehicle responds to commands. */
trait VelocityResponse:
  def create(): Vehicle

  /** Time from the arrival of a command until it replaces the one in effect, s. The first command takes
    * effect immediately.
    */
  def handoverS: Double = 0.0

  /** Whether the vehicles perform every action. Otherwise they follow horizontal velocities at the altitude
    * of their start.
    */
  def isSpatial: Boolean = false

  /** Whether the vehicles perform an action, in addition to horizontal velocities at the altitude of their
    * start.
    */
  def performs: Action => Boolean = _ => isSpatial

  /** Whether the vehicles' motion depends on a commanded yaw. */
  def regardsYaw: Boolean = true

  /** Errors of the vehicles' readings; without them readings are true. */
  def sensors: Option[SensorNoise] = None

  /** The model that best predicts such a vehicle. */
  def predictor: VehicleModel[?] = QuadrotorModel.AirSim

  /** The vehicles themselves, without errors of readings. */
  private[skein] def body: VelocityResponse = this

  /** The model that predicts such a vehicle under a loop that predicts by `loop`. */
  private[skein] def predictorUnder(loop: VehicleModel[?]): VehicleModel[?] = loop
