package skein.ros.message

/** A type of messages that topics carry: its package and name in ROS 2, and its encoding. */
final class MessageType[A](val packageName: String, val name: String)(using val cdr: Cdr[A]):
  override def toString: String = s"$packageName/msg/$name"

object MessageType:
  given MessageType[Clock] = MessageType("rosgraph_msgs", "Clock")

  given MessageType[PoseStamped]      = MessageType("geometry_msgs", "PoseStamped")
  given MessageType[TransformStamped] = MessageType("geometry_msgs", "TransformStamped")
  given MessageType[Twist]            = MessageType("geometry_msgs", "Twist")
  given MessageType[TwistStamped]     = MessageType("geometry_msgs", "TwistStamped")
  given MessageType[TFMessage]        = MessageType("tf2_msgs", "TFMessage")
  given MessageType[Odometry]         = MessageType("nav_msgs", "Odometry")

  given MessageType[Imu]             = MessageType("sensor_msgs", "Imu")
  given MessageType[NavSatFix]       = MessageType("sensor_msgs", "NavSatFix")
  given MessageType[Image]           = MessageType("sensor_msgs", "Image")
  given MessageType[CompressedImage] = MessageType("sensor_msgs", "CompressedImage")
  given MessageType[CameraInfo]      = MessageType("sensor_msgs", "CameraInfo")
  given MessageType[PointCloud2]     = MessageType("sensor_msgs", "PointCloud2")
  given MessageType[LaserScan]       = MessageType("sensor_msgs", "LaserScan")
