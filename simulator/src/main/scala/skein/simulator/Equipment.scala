package skein.simulator

import scala.util.control.NonFatal
import skein.airsim.{SensorKind, SettingsError, WorldSettings}
import skein.scene.{Lidar, Placement}
import skein.units.Vector3
import ujson.{Num, Obj, Str, Value}

/** What vehicles carry by a `settings.json`: cameras, lidars and distance sensors. Keys and defaults are AirSim's; of a
  * lidar there are three more: `RangeNoise` (standard deviation, m), `NoiseSeed`, and `Fresh` (a scan of the instant at which it is asked
  * for).
  *
  * @param captures
  *   of `CameraDefaults`, by image type
  */
final private[simulator] case class Equipment(
    captures: Map[Int, Equipment.Capture],
    cameras: Map[String, Map[String, Equipment.Carried]],
    lidars: Map[String, Vector[(String, Lidar)]],
    rangers: Map[String, Vector[(String, Equipment.Ranger)]]
):
  /** The size of pictures, and their field of view, of a vehicle's camera. */
  def capture(vehicle: String, camera: String, imageType: Int): Equipment.Capture =
    cameras.get(vehicle).flatMap(_.get(camera)).flatMap(_.captures.get(imageType))
      .orElse(captures.get(imageType)).getOrElse(Equipment.Capture())

  /** The empty name means the first. */
  def lidar(vehicle: String, name: String): Option[(String, Lidar)] =
    lidars.getOrElse(vehicle, Vector.empty).find((own, _) => name.isEmpty || own == name)

  def ranger(vehicle: String, name: String): Option[Equipment.Ranger] =
    rangers.getOrElse(vehicle, Vector.empty).find((own, _) => name.isEmpty || own == name).map(_._2)

private[simulator] object Equipment:
  final case class Capture(width: Int = 256, height: Int = 144, fovDeg: Float = 90)

  /** A camera of the settings.
    *
    * @param place
    *   on the vehicle; None: where the built-in one of its name is
    */
  final case class Carried(place: Option[Placement], captures: Map[Int, Capture])

  /** A distance sensor: looks along its front. */
  final case class Ranger(place: Placement, leastM: Double = 0.2, mostM: Double = 40)

  /** Of a picture. */
  val MostPixels: Int = 8192 * 4096

  val None: Equipment = Equipment(Map.empty, Map.empty, Map.empty, Map.empty)

  /** Reads it from the file's text, which is JSON. */
  def read(text: String): Either[SettingsError, Equipment] =
    try
      ujson.read(text) match
        case root: Obj => Right(of(Section(root, "")))
        case _         => Right(None)
    catch
      case e: Misfit   => Left(e.error)
      case NonFatal(e) => Left(WorldSettings.notJson(text, e))

  private def of(root: Section): Equipment =
    val vehicles                                         = root.sections("Vehicles")
    val unless                                           = root.sections("DefaultSensors")
    def sensors[A](kind: SensorKind)(read: Section => A) = vehicles.map: (name, vehicle) =>
      // As for other kinds, what a vehicle lists of a kind stands for what the defaults list of it.
      def listed(all: Vector[(String, Section)]) =
        all.filter((_, sensor) => sensor.number("SensorType", 0) == kind.number.toDouble)
      val own = listed(vehicle.sections("Sensors"))
      name -> (if own.nonEmpty then own else listed(unless))
        .filter((_, sensor) => sensor.flag("Enabled", default = false))
        .map((sensorName, sensor) => sensorName -> read(sensor))
    .toMap
    Equipment(
      captures(root.section("CameraDefaults"), Capture()),
      vehicles.map((name, vehicle) =>
        name -> vehicle.sections("Cameras").map((n, c) => n -> camera(c)).toMap
      ).toMap,
      sensors(SensorKind.Lidar)(lidar),
      sensors(SensorKind.Distance)(sensor =>
        Ranger(sensor.place, sensor.number("MinDistance", 0.2), sensor.number("MaxDistance", 40))
      )
    )

  private def camera(section: Section): Carried =
    val placed = Seq("X", "Y", "Z", "Roll", "Pitch", "Yaw").exists(section.has)
    Carried(Option.when(placed)(section.place), captures(section, Capture()))

  private def captures(section: Section, unless: Capture): Map[Int, Capture] =
    section.list("CaptureSettings").map: capture =>
      val width  = capture.number("Width", unless.width, 1, 8192).toInt
      val height = capture.number("Height", unless.height, 1, 8192).toInt
      if width.toLong * height > MostPixels then
        capture.fail("Height", s"at most $MostPixels pixels", s"$width × $height")
      capture.number("ImageType", 0, -1, 99).toInt ->
        Capture(width, height, capture.number("FOV_Degrees", unless.fovDeg, 1, 179).toFloat)
    .toMap

  private def lidar(section: Section): Lidar =
    val unless = Lidar()
    Lidar(
      channels = section.number("NumberOfChannels", unless.channels, 1, 1024).toInt,
      rangeM = section.number("Range", unless.rangeM, 0.01, 100_000),
      pointsPerSecond = section.number("PointsPerSecond", unless.pointsPerSecond, 1, 100_000_000).toInt,
      rotationsPerSecond = section.number("RotationsPerSecond", unless.rotationsPerSecond, 1, 1000).toInt,
      horizontalFovDeg = (
        section.number("HorizontalFOVStart", unless.horizontalFovDeg._1, -360, 360),
        section.number("HorizontalFOVEnd", unless.horizontalFovDeg._2, -360, 360)
      ),
      verticalFovDeg = (
        section.number("VerticalFOVLower", unless.verticalFovDeg._1, -90, 90),
        section.number("VerticalFOVUpper", unless.verticalFovDeg._2, -90, 90)
      ),
      place = section.place,
      sensorFrame = section.text("DataFrame", "VehicleInertialFrame") match
        case "VehicleInertialFrame" => false
        case "SensorLocalFrame"     => true
        case other => section.fail("DataFrame", "VehicleInertialFrame or SensorLocalFrame", s"'$other'")
      ,
      noiseM = section.number("RangeNoise", 0, 0, 100),
      seed = section.number("NoiseSeed", 0, -1e15, 1e15).toLong,
      fresh = section.flag("Fresh", default = false)
    )

  final private class Misfit(val error: SettingsError)
      extends RuntimeException(
        error.message,
        null, /* enableSuppression = */ false, /* writableStackTrace = */ false
      )

  /** An object of the file, and where it stands. */
  final private class Section(fields: Obj, path: String):
    def has(key: String): Boolean = fields.value.contains(key)

    def fail(key: String, expected: String, found: String): Nothing =
      throw Misfit(SettingsError.Unexpected(s"$path.$key".stripPrefix("."), expected, found))

    def number(key: String, unless: Double, least: Double = -1e9, most: Double = 1e9): Double =
      fields.value.get(key) match
        case Some(Num(value)) if value >= least && value <= most => value
        case Some(other) => fail(key, s"a number from $least to $most", other.render())
        case scala.None  => unless

    def text(key: String, unless: String): String = fields.value.get(key) match
      case Some(Str(value)) => value
      case Some(other)      => fail(key, "a string", other.render())
      case scala.None       => unless

    def flag(key: String, default: Boolean): Boolean = fields.value.get(key) match
      case Some(ujson.Bool(value)) => value
      case Some(other)             => fail(key, "true or false", other.render())
      case scala.None              => default

    def section(key: String): Section = fields.value.get(key).fold(Section(Obj(), path))(of(key, _))

    def sections(key: String): Vector[(String, Section)] =
      val inner = section(key)
      inner.all.map((name, value) => name -> inner.of(name, value))

    def list(key: String): Vector[Section] = fields.value.get(key) match
      case Some(values: ujson.Arr) => values.value.toVector.map(of(key, _))
      case Some(other)             => fail(key, "a list", other.render())
      case scala.None              => Vector.empty

    def place: Placement = Placement.turned(
      Vector3(number("X", 0), number("Y", 0), number("Z", 0)),
      number("Roll", 0),
      number("Pitch", 0),
      number("Yaw", 0)
    )

    private def all: Vector[(String, Value)] =
      if path == "" && fields.value.isEmpty then Vector.empty else fields.value.toVector

    private def of(key: String, value: Value): Section = value match
      case inner: Obj => Section(inner, s"$path.$key".stripPrefix("."))
      case other      => fail(key, "an object", other.render())
