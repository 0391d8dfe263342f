package skein.simulator

import skein.airsim.VehicleSettings
import skein.airsim.wire.KinematicsState
import skein.scene.{Scene, SceneObject}
import skein.units.*

/** AirSim's `ComputerVision` vehicle: a fixed rig of cameras. Physics does not move it, nothing collides with
  * it, and it is invisible. It carries a multirotor's cameras and sensors.
  */
final private[simulator] class SimulatedCamera(settings: VehicleSettings, worldOrigin: GeoLocation)
    extends SimulatedVehicle(settings, worldOrigin):
  private var position = Vector3.Zero
  private var attitude = Quaternion.Identity

  reset(Instant.Epoch)

  def kind: String = "camera"

  def setApiControl(on: Boolean): Unit = controlled = on

  def arm(on: Boolean): Boolean = true

  def reset(at: Instant): Unit =
    position = Vector3.Zero
    attitude = Quaternion.ofYaw(settings.yaw.value)
    controlled = false
    begin(at)

  def setWind(windNed: Vector3): Unit = ()

  def step(at: Instant, scene: Scene): Unit = sampledAt = at

  def place(positionNed: Vector3, orientation: Quaternion, at: Instant): Unit =
    position = positionNed
    attitude = orientation.normalized

  /** Moves the rig to the position; the motion is ignored. */
  def setKinematics(kinematics: KinematicsState, at: Instant): Unit =
    place(kinematics.position.toVector, kinematics.orientation.toQuaternion, at)

  def flying: Boolean                  = false
  def isGrounded: Boolean              = true
  def positionAt(at: Instant): Vector3 = position
  def velocityAt(at: Instant): Vector3 = Vector3.Zero
  def orientation: Quaternion          = attitude
  def angularVelocityFrd: Vector3      = Vector3.Zero
  def accelerationNed: Vector3         = Vector3.Zero
  def angularAccelerationFrd: Vector3  = Vector3.Zero
  def halfLengths: Vector3             = Vector3.Zero
  def middleFrd: Vector3               = Vector3.Zero
  def cameras: CameraSet               = CameraSet.OfMultirotor

  def parts(number: Int, tagM: Double): Vector[SceneObject.Part] = Vector.empty
