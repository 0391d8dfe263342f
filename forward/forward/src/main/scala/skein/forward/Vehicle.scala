package skein.forward

import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{QuadrotorModel, VehicleModel}

/** One vehicle of a rollout that follows commanded horizontal velocities. Mutable; one per vehicle and
  * thread.
  */
trait Vehicle:
  /** Places it at rest, at time 0; world NED, m. */
  def start(x: Double, y: Double, z: Double): Unit

  /** A command (m/s, north and east) that arrives now. It acts after the vehicle's dead time, and until
    * another does.
    */
  def command(vx: Double, vy: Double): Unit

  /** Flies until this time, s; never earlier than the call before. */
  def advance(timeS: Double): Unit

  /** Position north of the world's origin, m. */
  def x: Double

  /** East, m. */
  def y: Double

  /** Velocity north, m/s. */
  def vx: Double

  /** East, m/s. */
  def vy: Double

  // The same as the vehicle tells it when it is asked.
  def seenX: Double  = x
  def seenY: Double  = y
  def seenVx: Double = vx
  def seenVy: Double = vy

  /** All that it tells. Where a vehicle knows no more than its horizontal motion: level, not turning, at z =
    * 0.
    */
  def seen: Kinematics = level(0)

  protected def level(downM: Double): Kinematics =
    Kinematics(Vector3(seenX, seenY, downM), Vector3(seenVx, seenVy, 0), Quaternion.Identity, Vector3.Zero)

/** How a vehicle answers to commanded velocities. */
trait VelocityResponse:
  def create(): Vehicle

  /** From the arrival of a command until it acts in the place of another, s. The first acts at once. */
  def handoverS: Double = 0.0

  /** Whether it flies otherwise when it is told to turn. */
  def regardsYaw: Boolean = true

  /** What carries readings of such a vehicle forward best. */
  def predictor: VehicleModel[?] = QuadrotorModel.AirSim
