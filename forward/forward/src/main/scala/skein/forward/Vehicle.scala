package skein.forward

import skein.policy.Action
import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{QuadrotorModel, VehicleModel}

/** One vehicle of a rollout. Mutable; one per vehicle and thread. */
trait Vehicle:
  /** Sets it to rest here, at time 0; world NED, m. */
  def start(x: Double, y: Double, z: Double): Unit

  /** A horizontal velocity at the altitude of the start, or another action that it
    * [[VelocityResponse.performs performs]], which arrives now. It takes effect after the vehicle's dead
    * time, until another does.
    */
  def act(action: Action): Unit

  /** Simulates until this time, s; times must not decrease. */
  def advance(timeS: Double): Unit

  def x: Double

  def y: Double

  def z: Double

  def vx: Double

  def vy: Double

  // The same as the vehicle tells it when it is asked.
  def seenX: Double  = x
  def seenY: Double  = y
  def seenZ: Double  = z
  def seenVx: Double = vx
  def seenVy: Double = vy

  /** Its reading. A model of horizontal motion alone reports a level vehicle without rotation at z = 0. */
  def seen: Kinematics = level(0)

  protected def level(downM: Double): Kinematics =
    Kinematics(Vector3(seenX, seenY, downM), Vector3(seenVx, seenVy, 0), Quaternion.Identity, Vector3.Zero)

/** How a vehicle responds to commanded velocities. */
trait VelocityResponse:
  def create(): Vehicle

  /** From the arrival of a command until it replaces the one in effect, s. The first takes effect
    * immediately.
    */
  def handoverS: Double = 0.0

  /** Whether its vehicles perform every action. Others follow horizontal velocities at the altitude of their
    * start.
    */
  def isSpatial: Boolean = false

  /** Whether its vehicles perform an action, besides velocities at the altitude of their start. */
  def performs: Action => Boolean = _ => isSpatial

  /** Whether its motion depends on a commanded yaw. */
  def regardsYaw: Boolean = true

  /** The model that predicts such a vehicle best. */
  def predictor: VehicleModel[?] = QuadrotorModel.AirSim
