package skein.ros.message

/** Definitions of message types, as text of `.msg` files. */
object MessageDefinition:

  /** The definition of a type, followed by those of the types in it, as a bag holds them: the encoding
    * `ros2msg` of MCAP's registry (https://mcap.dev/spec/registry).
    */
  def whole(kind: MessageType[?]): String =
    val name = s"${kind.packageName}/${kind.name}"
    (text(name) +: inside(name).map(part => s"${"=" * 80}\nMSG: $part\n${text(part)}")).mkString

  /** Names of a type's fields, in the order of their bytes. */
  private[message] def fieldNames(name: String): Vector[String] = fields(name).map(_.last)

  /** Types within a type, each once, at any depth. */
  private def inside(name: String): Vector[String] =
    fields(name).map(_.head.takeWhile(_ != '[')).filter(all.contains)
      .flatMap(part => part +: inside(part)).distinct

  private def text(name: String): String = fields(name).map(_.mkString(" ") + "\n").mkString

  private def fields(name: String): Vector[Vector[String]] =
    all(name).split(", ").toVector.map(_.split(' ').toVector)

  /** Source: the packages of ROS 2 Jazzy; constants and defaults are left out, as they do not matter to
    * readers.
    */
  private val all = Map(
    "builtin_interfaces/Time"  -> "int32 sec, uint32 nanosec",
    "std_msgs/Header"          -> "builtin_interfaces/Time stamp, string frame_id",
    "geometry_msgs/Point"      -> "float64 x, float64 y, float64 z",
    "geometry_msgs/Vector3"    -> "float64 x, float64 y, float64 z",
    "geometry_msgs/Quaternion" -> "float64 x, float64 y, float64 z, float64 w",
    "geometry_msgs/Pose"       -> "geometry_msgs/Point position, geometry_msgs/Quaternion orientation",
    "geometry_msgs/PoseWithCovariance"  -> "geometry_msgs/Pose pose, float64[36] covariance",
    "geometry_msgs/Twist"               -> "geometry_msgs/Vector3 linear, geometry_msgs/Vector3 angular",
    "geometry_msgs/TwistStamped"        -> "std_msgs/Header header, geometry_msgs/Twist twist",
    "geometry_msgs/TwistWithCovariance" -> "geometry_msgs/Twist twist, float64[36] covariance",
    "geometry_msgs/Transform" -> "geometry_msgs/Vector3 translation, geometry_msgs/Quaternion rotation",
    "geometry_msgs/TransformStamped" ->
      "std_msgs/Header header, string child_frame_id, geometry_msgs/Transform transform",
    "tf2_msgs/TFMessage" -> "geometry_msgs/TransformStamped[] transforms",
    "nav_msgs/Odometry"  ->
      ("std_msgs/Header header, string child_frame_id, geometry_msgs/PoseWithCovariance pose, " +
        "geometry_msgs/TwistWithCovariance twist"),
    "sensor_msgs/Image" ->
      ("std_msgs/Header header, uint32 height, uint32 width, string encoding, uint8 is_bigendian, " +
        "uint32 step, uint8[] data"),
    "sensor_msgs/PointField"  -> "string name, uint32 offset, uint8 datatype, uint32 count",
    "sensor_msgs/PointCloud2" ->
      ("std_msgs/Header header, uint32 height, uint32 width, sensor_msgs/PointField[] fields, " +
        "bool is_bigendian, uint32 point_step, uint32 row_step, uint8[] data, bool is_dense")
  )
