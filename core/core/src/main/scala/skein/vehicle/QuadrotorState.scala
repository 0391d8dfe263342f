package skein.vehicle

import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}

/** The state of a quadrotor: kinematics, rotors and the memory of its flight controller. Mutable and flat, so
  * that a step allocates nothing; [[copyFrom]] makes it equal to another. Create one with
  * [[Quadrotor.hovering]] or [[Quadrotor.landed]].
  *
  * World frame NED, body frame FRD, metres, seconds, radians.
  */
final class QuadrotorState:
  var x, y, z = 0.0

  var vx, vy, vz = 0.0

  /** Acceleration (north, east, down), m/s², gravity included. */
  var ax, ay, az = 0.0

  /** Orientation, body to world, a unit quaternion. */
  var qw         = 1.0
  var qx, qy, qz = 0.0

  /** Angular velocity (front, right, down), rad/s. */
  var wx, wy, wz = 0.0

  /** Angular acceleration (front, right, down), rad/s². */
  var wxDot, wyDot, wzDot = 0.0

  /** The last controls of the rotors set by the controller, 0 to 1. */
  var control0, control1, control2, control3 = 0.0

  /** Controls of the rotors after their lag, 0 to 1. */
  var lagged0, lagged1, lagged2, lagged3 = 0.0

  /** Thrust in the next step, divided by the maximum thrust at sea-level density. */
  var thrust0, thrust1, thrust2, thrust3 = 0.0

  /** Whether the vehicle stands on the ground, until thrust exceeds weight. */
  var grounded = false

  /** Integral term of the vertical velocity controller, −1 to 1. */
  private[vehicle] var verticalIntegral = 0.0

  /** Vertical mode of the previous step; null before the first. A change of mode recreates the vertical
    * controllers. The other axes have no memory, because their integral gains are zero.
    */
  private[vehicle] var verticalMode: VerticalMode | Null = null

  /** Memory of a [[TunedFlightController]] for all axes; null under a plain [[FlightController]]. */
  private[vehicle] var cascadeMemory: CascadeMemory | Null = null

  /** Resets all controllers at the next step, as when AirSim's gains are set. */
  def restartController(): Unit =
    verticalMode = null
    cascadeMemory = null

  var contacts = 0

  def copy: QuadrotorState =
    val same = QuadrotorState()
    same.copyFrom(this)
    same

  def copyFrom(other: QuadrotorState): Unit =
    x = other.x; y = other.y; z = other.z
    vx = other.vx; vy = other.vy; vz = other.vz
    ax = other.ax; ay = other.ay; az = other.az
    qw = other.qw; qx = other.qx; qy = other.qy; qz = other.qz
    wx = other.wx; wy = other.wy; wz = other.wz
    wxDot = other.wxDot; wyDot = other.wyDot; wzDot = other.wzDot
    control0 = other.control0; control1 = other.control1
    control2 = other.control2; control3 = other.control3
    lagged0 = other.lagged0; lagged1 = other.lagged1; lagged2 = other.lagged2; lagged3 = other.lagged3
    thrust0 = other.thrust0; thrust1 = other.thrust1; thrust2 = other.thrust2; thrust3 = other.thrust3
    grounded = other.grounded
    contacts = other.contacts
    verticalIntegral = other.verticalIntegral
    verticalMode = other.verticalMode
    cascadeMemory = if other.cascadeMemory == null then null else other.cascadeMemory.nn.copy

  def positionNed: Vector3            = Vector3(x, y, z)
  def velocityNed: Vector3            = Vector3(vx, vy, vz)
  def accelerationNed: Vector3        = Vector3(ax, ay, az)
  def orientation: Quaternion         = Quaternion(qw, qx, qy, qz)
  def angularVelocityFrd: Vector3     = Vector3(wx, wy, wz)
  def angularAccelerationFrd: Vector3 = Vector3(wxDot, wyDot, wzDot)

  def kinematics: Kinematics = Kinematics(positionNed, velocityNed, orientation, angularVelocityFrd)

  /** Angle between the thrust of the rotors and straight up, rad. */
  def tiltRad: Double = StrictMath.acos((1 - 2 * (qx * qx + qy * qy)).max(-1.0).min(1.0))

  def yawRad: Double = StrictMath.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))

  /** Moves the vehicle to a position, level and with the yaw of `orientation`. Its motion and controller are
    * unchanged, as in AirSim's `simSetVehiclePose`.
    */
  def place(positionNed: Vector3, orientation: Quaternion): Unit =
    x = positionNed.x; y = positionNed.y; z = positionNed.z
    qw = orientation.w; qx = orientation.x; qy = orientation.y; qz = orientation.z
