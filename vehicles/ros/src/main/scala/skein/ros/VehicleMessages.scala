package skein.ros

import skein.ros.message.*
import skein.signal.Kinematics
import skein.simulator.SeenVehicle
import skein.units.Instant
import skein.vehicle.Airframe

/** A vehicle's motion as messages. All covariances are zero. */
object VehicleMessages:
  /** The world's frame: east, north, up, with the origin of the simulator's settings. */
  val World = "map"

  def body(vehicle: String): String = s"$vehicle/base_link"

  def odometry(at: Instant, vehicle: String, motion: Kinematics): Odometry = Odometry(
    Header(Time.of(at), World),
    body(vehicle),
    PoseWithCovariance(Pose(point(motion.positionNed), rotation(motion.orientation)), Doubles.zero),
    TwistWithCovariance(
      Twist(vector(RosFrames.swapBody(motion.orientation.toBody(motion.velocityNed))), turning(motion)),
      Doubles.zero
    )
  )

  /** The pose of a vehicle's body frame in the world. */
  def transform(at: Instant, vehicle: String, motion: Kinematics): TransformStamped =
    transform(at, body(vehicle), motion.positionNed, RosFrames.toEnu(motion.orientation))

  /** The pose of a frame in the world.
    *
    * @param toEnu the rotation from the frame to the world
    */
  def transform(
      at: Instant,
      frame: String,
      positionNed: skein.units.Vector3,
      toEnu: skein.units.Quaternion
  ): TransformStamped = TransformStamped(
    Header(Time.of(at), World),
    frame,
    Transform(vector(RosFrames.swapWorld(positionNed)), quaternion(toEnu))
  )

  /** The acceleration is what an accelerometer measures: without motion, gravity's reaction upwards. */
  private[ros] def imu(at: Instant, vehicle: SeenVehicle): Imu =
    val felt = vehicle.accelerationNed - skein.units.Vector3(0, 0, Airframe.Gravity)
    Imu(
      Header(Time.of(at), body(vehicle.name)),
      rotation(vehicle.kinematics.orientation),
      Doubles.zero,
      turning(vehicle.kinematics),
      Doubles.zero,
      vector(RosFrames.swapBody(vehicle.kinematics.orientation.toBody(felt))),
      Doubles.zero
    )

  /** The altitude is above the simulator's sphere, whose surface is at sea level. */
  private[ros] def fix(at: Instant, vehicle: SeenVehicle): NavSatFix = NavSatFix(
    Header(Time.of(at), body(vehicle.name)),
    NavSatStatus(0, Gps),
    vehicle.location.latitudeDeg,
    vehicle.location.longitudeDeg,
    vehicle.location.altitude.value,
    Doubles.zero,
    Unknown
  )

  private val Gps: Short    = 1
  private val Unknown: Byte = 0

  private def turning(motion: Kinematics) = vector(RosFrames.swapBody(motion.angularVelocityFrd))

  private def rotation(nedFromFrd: skein.units.Quaternion) = quaternion(RosFrames.toEnu(nedFromFrd))

  private def quaternion(q: skein.units.Quaternion) = Quaternion(q.x, q.y, q.z, q.w)

  private def point(ned: skein.units.Vector3) =
    val enu = RosFrames.swapWorld(ned)
    Point(enu.x, enu.y, enu.z)

  private def vector(v: skein.units.Vector3) = Vector3(v.x, v.y, v.z)
