package skein.ros.message

/** `geometry_msgs/Vector3`: a direction or a velocity in its message's frame. */
final case class Vector3(x: Double, y: Double, z: Double) derives Cdr

/** `geometry_msgs/Point`: a position in its message's frame, m. */
final case class Point(x: Double, y: Double, z: Double) derives Cdr

/** `geometry_msgs/Quaternion`: a rotation from a body to its message's frame. */
final case class Quaternion(x: Double, y: Double, z: Double, w: Double) derives Cdr

/** `geometry_msgs/Pose`: position and orientation of a body. */
final case class Pose(position: Point, orientation: Quaternion) derives Cdr

/** `geometry_msgs/PoseStamped`: a pose with its time and frame. */
final case class PoseStamped(header: Header, pose: Pose) derives Cdr

/** `geometry_msgs/PoseWithCovariance`: the covariance is of x, y, z and rotations about them. */
final case class PoseWithCovariance(pose: Pose, covariance: Doubles[36]) derives Cdr

/** `geometry_msgs/Twist`: velocities, m/s and rad/s. */
final case class Twist(linear: Vector3, angular: Vector3) derives Cdr

/** `geometry_msgs/TwistStamped`: velocities with their time and frame. */
final case class TwistStamped(header: Header, twist: Twist) derives Cdr

/** `geometry_msgs/TwistWithCovariance`: the covariance is of velocities along and about x, y, z. */
final case class TwistWithCovariance(twist: Twist, covariance: Doubles[36]) derives Cdr

/** `geometry_msgs/Transform`: the position and rotation of one frame in another. */
final case class Transform(translation: Vector3, rotation: Quaternion) derives Cdr

/** `geometry_msgs/TransformStamped`: the frame `childFrameId` in the header's frame. */
final case class TransformStamped(header: Header, childFrameId: String, transform: Transform) derives Cdr

/** `tf2_msgs/TFMessage`: transforms between frames, as `/tf` carries them. */
final case class TFMessage(transforms: Vector[TransformStamped]) derives Cdr

/** `nav_msgs/Odometry`: a pose in the header's frame, and velocities in the child's. */
final case class Odometry(
    header: Header,
    childFrameId: String,
    pose: PoseWithCovariance,
    twist: TwistWithCovariance
) derives Cdr
