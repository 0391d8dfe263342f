package skein.ros

import skein.ros.message.*
import skein.simulator.SeenVehicle
import skein.units.Instant
import skein.vehicle.Airframe

/** A simulated vehicle's motion as messages. They are exact, so all covariances are zero. */
private[ros] object VehicleMessages:
  /** The world's frame: east, north, up, with the origin of the simulator's settings. */
  val World = "map"

  def body(vehicle: String): String = s"$vehicle/base_link"

  def odometry(at: Instant, vehicle: SeenVehicle): Odometry = Odometry(
    Header(Time.of(at), World),
    body(vehicle.name),
    PoseWithCovariance(Pose(point(position(vehicle)), rotation(vehicle)), Doubles.zero),
    TwistWithCovariance(
      Twist(
        vector(RosFrames.swapBody(vehicle.kinematics.orientation.toBody(vehicle.kinematics.velocityNed))),
        turning(vehicle)
      ),
      Doubles.zero
    )
  )

  def transform(at: Instant, vehicle: SeenVehicle): TransformStamped = TransformStamped(
    Header(Time.of(at), World),
    body(vehicle.name),
    Transform(vector(position(vehicle)), rotation(vehicle))
  )

  /** The acceleration is what an accelerometer feels: without motion, gravity's reaction upwards. */
  def imu(at: Instant, vehicle: SeenVehicle): Imu =
    val felt = vehicle.accelerationNed - skein.units.Vector3(0, 0, Airframe.Gravity)
    Imu(
      Header(Time.of(at), body(vehicle.name)),
      rotation(vehicle),
      Doubles.zero,
      turning(vehicle),
      Doubles.zero,
      vector(RosFrames.swapBody(vehicle.kinematics.orientation.toBody(felt))),
      Doubles.zero
    )

  /** The altitude is above the simulator's sphere, at whose surface sea level is. */
  def fix(at: Instant, vehicle: SeenVehicle): NavSatFix = NavSatFix(
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

  private def position(vehicle: SeenVehicle) = RosFrames.swapWorld(vehicle.kinematics.positionNed)

  private def turning(vehicle: SeenVehicle) =
    vector(RosFrames.swapBody(vehicle.kinematics.angularVelocityFrd))

  private def rotation(vehicle: SeenVehicle) =
    val q = RosFrames.toEnu(vehicle.kinematics.orientation)
    Quaternion(q.x, q.y, q.z, q.w)

  private def point(v: skein.units.Vector3)  = Point(v.x, v.y, v.z)
  private def vector(v: skein.units.Vector3) = Vector3(v.x, v.y, v.z)
