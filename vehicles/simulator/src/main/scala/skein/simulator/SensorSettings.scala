package skein.simulator

import skein.airsim.{SensorKind, SettingsError, SettingsSection}
import skein.scene.{Lidar, Placement}

/** What vehicles carry by a `settings.json`: cameras, lidars and distance sensors. Keys and defaults are
  * AirSim's; of a lidar there are three more: `RangeNoise` (standard deviation, m), `NoiseSeed`, and `Fresh`
  * (a scan of the instant at which it is asked for).
  *
  * @param captures of `CameraDefaults`, by image type
  */
final private[simulator] case class SensorSettings(
    captures: Map[Int, SensorSettings.Capture],
    cameras: Map[String, Map[String, SensorSettings.Carried]],
    lidars: Map[String, Vector[(String, Lidar)]],
    rangers: Map[String, Vector[(String, SensorSettings.Ranger)]]
):
  /** The size of images, and their field of view, of a vehicle's camera. */
  def capture(vehicle: String, camera: String, imageType: Int): SensorSettings.Capture =
    cameras.get(vehicle).flatMap(_.get(camera)).flatMap(_.captures.get(imageType))
      .orElse(captures.get(imageType)).getOrElse(SensorSettings.Capture())

  /** The empty name means the first. */
  def lidar(vehicle: String, name: String): Option[(String, Lidar)] =
    lidars.getOrElse(vehicle, Vector.empty).find((own, _) => name.isEmpty || own == name)

  def ranger(vehicle: String, name: String): Option[SensorSettings.Ranger] =
    rangers.getOrElse(vehicle, Vector.empty).find((own, _) => name.isEmpty || own == name).map(_._2)

private[simulator] object SensorSettings:
  final case class Capture(width: Int = 256, height: Int = 144, fovDeg: Float = 90)

  /** A camera of the settings.
    *
    * @param place on the vehicle; None: where the built-in one of its name is
    */
  final case class Carried(place: Option[Placement], captures: Map[Int, Capture])

  /** A distance sensor: looks along its front. */
  final case class Ranger(place: Placement, leastM: Double = 0.2, mostM: Double = 40)

  /** Of an image. */
  val MostPixels: Int = 8192 * 4096

  val None: SensorSettings = SensorSettings(Map.empty, Map.empty, Map.empty, Map.empty)

  /** Reads it from the file's text, which is JSON. */
  def read(text: String): Either[SettingsError, SensorSettings] = SettingsSection.read(text)(of)

  private def of(root: SettingsSection): SensorSettings =
    val vehicles                                                 = root.sections("Vehicles")
    val unless                                                   = root.sections("DefaultSensors")
    def sensors[A](kind: SensorKind)(read: SettingsSection => A) = vehicles.map: (name, vehicle) =>
      // As for other kinds, what a vehicle lists of a kind stands for what the defaults list of it.
      def listed(all: Vector[(String, SettingsSection)]) =
        all.filter((_, sensor) => sensor.number("SensorType", 0) == kind.number.toDouble)
      val own = listed(vehicle.sections("Sensors"))
      name -> (if own.nonEmpty then own else listed(unless))
        .filter((_, sensor) => sensor.flag("Enabled", unless = false))
        .map((sensorName, sensor) => sensorName -> read(sensor))
    .toMap
    SensorSettings(
      captures(root.section("CameraDefaults"), Capture()),
      vehicles.map((name, vehicle) =>
        name -> vehicle.sections("Cameras").map((n, c) => n -> camera(c)).toMap
      ).toMap,
      sensors(SensorKind.Lidar)(lidar),
      sensors(SensorKind.Distance)(sensor =>
        Ranger(placeOf(sensor), sensor.number("MinDistance", 0.2), sensor.number("MaxDistance", 40))
      )
    )

  private def camera(section: SettingsSection): Carried =
    val placed = Seq("X", "Y", "Z", "Roll", "Pitch", "Yaw").exists(section.has)
    Carried(Option.when(placed)(placeOf(section)), captures(section, Capture()))

  private def captures(section: SettingsSection, unless: Capture): Map[Int, Capture] =
    section.list("CaptureSettings").map: capture =>
      val width  = capture.number("Width", unless.width, 1, 8192).toInt
      val height = capture.number("Height", unless.height, 1, 8192).toInt
      if width.toLong * height > MostPixels then
        capture.fail("Height", s"at most $MostPixels pixels", s"$width × $height")
      capture.number("ImageType", 0, -1, 99).toInt ->
        Capture(width, height, capture.number("FOV_Degrees", unless.fovDeg, 1, 179).toFloat)
    .toMap

  private def lidar(section: SettingsSection): Lidar =
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
      place = placeOf(section),
      sensorFrame = section.text("DataFrame", "VehicleInertialFrame") match
        case "VehicleInertialFrame" => false
        case "SensorLocalFrame"     => true
        case other => section.fail("DataFrame", "VehicleInertialFrame or SensorLocalFrame", s"'$other'")
      ,
      noiseM = section.number("RangeNoise", 0, 0, 100),
      seed = section.number("NoiseSeed", 0, -1e15, 1e15).toLong,
      fresh = section.flag("Fresh", unless = false)
    )

  private def placeOf(section: SettingsSection): Placement =
    Placement.turned(
      section.vector,
      section.number("Roll", 0),
      section.number("Pitch", 0),
      section.number("Yaw", 0)
    )
