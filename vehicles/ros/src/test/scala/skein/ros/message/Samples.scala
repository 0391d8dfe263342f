package skein.ros.message

import scala.collection.immutable.ArraySeq
import scala.io.Source

/** The messages that `write_messages.py` writes, and the bytes that it wrote. */
private[ros] object Samples:
  private val header = Header(Time(1700000000, 123456789), "map")
  private val turned = Quaternion(0.5, -0.5, 0.5, 0.5)
  private val twist  = Twist(Vector3(1.5, -2.25, 0.125), Vector3(0, -1e-3, 3))
  private val pose   = Pose(Point(1, -2, 3), turned)
  private val shift  = Transform(Vector3(1, -2, 3), turned)

  private def row[N <: Int](using size: ValueOf[N]): Doubles[N] =
    Doubles.of(Seq.tabulate(size.value)(_ * 0.5))

  private def in(frame: String) = header.copy(frameId = frame)

  private def data(bytes: Range) = ArraySeq.from(bytes.map(_.toByte))

  private val frame = TransformStamped(Header(Time(7, 8), "map"), "b", shift)

  /** A value with its type. */
  final case class Sample[A](value: A)(using val kind: MessageType[A]):
    /** Writes the value. */
    def written: Array[Byte]                          = Cdr.bytes(value)(using kind.cdr)
    def read(bytes: Array[Byte]): Either[String, Any] = Cdr.message(bytes)(using kind.cdr)

  val all: Vector[Sample[?]] = Vector(
    Sample(Clock(Time(-5, 999999999))),
    Sample(PoseStamped(header, pose)),
    Sample(TransformStamped(in("world frame"), "drone_1/base_link", shift)),
    Sample(twist),
    Sample(TwistStamped(in(""), twist)),
    Sample(Odometry(in("odom"), "a", PoseWithCovariance(pose, row), TwistWithCovariance(twist, row))),
    Sample(Imu(
      in("größe"),
      turned,
      row,
      Vector3(0.1, 0.2, 0.3),
      Doubles.zero,
      Vector3(0, 0, 9.81),
      Doubles.zero
    )),
    Sample(NavSatFix(in("gps"), NavSatStatus(-1, 9), 47.5, -122.25, 120, Doubles.zero, 2)),
    Sample(Image(in("camera"), 2, 3, "rgb8", 0, 9, data(238 until 256))),
    Sample(CompressedImage(in("camera"), "png", ArraySeq[Byte](1, 2, -1))),
    Sample(CameraInfo(
      in("camera"),
      480,
      640,
      "plumb_bob",
      ArraySeq(0.1, -0.2),
      row,
      row,
      row,
      1,
      2,
      RegionOfInterest(3, 4, 5, 6, doRectify = true)
    )),
    Sample(PointCloud2(
      in("lidar"),
      1,
      2,
      Vector("x", "y", "z").zipWithIndex.map((name, at) => PointField(name, 4 * at, 7, 1)),
      isBigendian = false,
      12,
      24,
      data(0 until 24),
      isDense = true
    )),
    Sample(LaserScan(
      in("laser"),
      -1.5f,
      1.5f,
      0.25f,
      0,
      0.125f,
      0.5f,
      30,
      ArraySeq(1.0f, Float.PositiveInfinity, 2.5f),
      ArraySeq.empty[Float]
    )),
    Sample(TFMessage(Vector(frame, frame)))
  )

  def of(name: String): Sample[?] = all.find(_.kind.name == name).get

  /** Name and bytes of each line of `messages.txt`. */
  lazy val written: Vector[(name: String, bytes: Array[Byte])] =
    val file = Source.fromResource("ros/messages.txt")
    try
      file
        .getLines()
        .map: line =>
          val Array(name, hex) = line.split(' '): @unchecked
          (name = name, bytes = hex.grouped(2).map(Integer.parseInt(_, 16).toByte).toArray)
        .toVector
    finally file.close()
