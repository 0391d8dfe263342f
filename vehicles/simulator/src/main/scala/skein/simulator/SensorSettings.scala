package skein.simulator

import skein.airsim.{SensorKind, SettingsError, SettingsSection, VehicleSettings, WorldSettings}
import skein.scene.{Lidar, Placement}
import skein.units.Vector3

/** The cameras, lidars and distance sensors of a `settings.json`. Keys and defaults are AirSim's; a lidar has
  * three more: `RangeNoise` (standard deviation, m), `NoiseSeed`, and `Fresh` (scans are taken on request, of
  * that instant). As in AirSim, lidars and distance sensors of cars and cameras are by default 1 m above the
  * vehicle, and their lidars see from 10° below the horizon to 10° above (`LidarSimpleParams`).
  *
  * @param captures image settings of `CameraDefaults`, by image type
  */
final private[skein] case class SensorSettings(
    captures: Map[Int, SensorSettings.Capture],
    cameras: Map[String, Map[String, SensorSettings.Carried]],
    lidars: SensorSettings.Fitted[Lidar],
    rangers: SensorSettings.Fitted[SensorSettings.Ranger]
):
  /** Image size and field of view of a vehicle's camera. */
  def capture(vehicle: String, camera: String, imageType: Int): SensorSettings.Capture =
    cameras.get(vehicle).flatMap(_.get(camera)).flatMap(_.captures.get(imageType))
      .orElse(captures.get(imageType)).getOrElse(SensorSettings.Capture())

  /** A vehicle's lidar by name; an empty name means the first. */
  def lidar(vehicle: VehicleSettings, name: String): Option[(String, Lidar)] =
    lidars.of(vehicle).find((own, _) => name.isEmpty || own == name)

  def ranger(vehicle: VehicleSettings, name: String): Option[SensorSettings.Ranger] =
    rangers.of(vehicle).find((own, _) => name.isEmpty || own == name).map(_._2)

private[skein] object SensorSettings:
  /** The sensors of one kind, by name.
    *
    * @param listed those of the vehicles that the file lists
    * @param flying those of `DefaultSensors`, for other multirotors: the default vehicle of a file without
    *   vehicles, and those that clients add
    * @param others those of `DefaultSensors`, for other cars and cameras
    */
  final case class Fitted[A](
      listed: Map[String, Vector[(String, A)]] = Map.empty,
      flying: Vector[(String, A)] = Vector.empty,
      others: Vector[(String, A)] = Vector.empty
  ):
    def of(vehicle: VehicleSettings): Vector[(String, A)] =
      listed.getOrElse(vehicle.name, if vehicle.isMultirotor then flying else others)

  final case class Capture(width: Int = 256, height: Int = 144, fovDeg: Float = 90)

  /** A camera of the settings.
    *
    * @param place placement on the vehicle; None: that of the built-in camera of its name
    */
  final case class Carried(place: Option[Placement], captures: Map[Int, Capture])

  /** A distance sensor, which measures along its front. */
  final case class Ranger(place: Placement, leastM: Double = 0.2, mostM: Double = 40)

  val MostPixels: Int = 8192 * 4096

  val None: SensorSettings = SensorSettings(Map.empty, Map.empty, Fitted(), Fitted())

  /** The sensors of a world's settings; none if its text is no settings file. */
  def of(world: WorldSettings): SensorSettings = read(world.text).getOrElse(None)

  /** Reads the sensors from the file's text, which is JSON. */
  def read(text: String): Either[SettingsError, SensorSettings] = SettingsSection.read(text)(root =>
    of(root, WorldSettings.read(root, text))
  )

  private[simulator] def of(root: SettingsSection, world: WorldSettings): SensorSettings =
    val vehicles = WorldSettings.created(root.sections("Vehicles"))
    val flies    = world.vehicles.map(vehicle => vehicle.name -> vehicle.isMultirotor).toMap
    val unless   = root.sections("DefaultSensors")
    def sensors[A](kind: SensorKind)(read: (SettingsSection, Boolean) => A) =
      def listed(all: Vector[(String, SettingsSection)]) =
        all.filter((_, sensor) => sensor.number("SensorType", 0) == kind.number.toDouble)
      def enabled(all: Vector[(String, SettingsSection)], flies: Boolean) = all
        .filter((_, sensor) => sensor.flag("Enabled", unless = false))
        .map((sensorName, sensor) => sensorName -> read(sensor, flies))
      val shared = listed(unless)
      val own    = vehicles.map: (name, vehicle) =>
        // As for other kinds, a vehicle's own list of a kind replaces the default list.
        val own = listed(vehicle.sections("Sensors"))
        name -> enabled(if own.nonEmpty then own else shared, flies(name))
      Fitted(own.toMap, enabled(shared, flies = true), enabled(shared, flies = false))
    SensorSettings(
      captures(root.section("CameraDefaults"), Capture()),
      vehicles.map((name, vehicle) =>
        name -> vehicle.sections("Cameras").map((n, c) => n -> camera(c)).toMap
      ).toMap,
      sensors(SensorKind.Lidar)(lidar),
      sensors(SensorKind.Distance)((sensor, flies) =>
        Ranger(
          placeOf(sensor, downM(flies)),
          sensor.number("MinDistance", 0.2),
          sensor.number("MaxDistance", 40)
        )
      )
    )

  private def camera(section: SettingsSection): Carried =
    val placed = Seq("X", "Y", "Z", "Roll", "Pitch", "Yaw").exists(section.has)
    Carried(Option.when(placed)(placeOf(section)), captures(section, Capture()))

  private def captures(section: SettingsSection, unless: Capture): Map[Int, Capture] =
    section.list("CaptureSettings").map: capture =>
      val width  = capture.whole("Width", unless.width, 1, 8192)
      val height = capture.whole("Height", unless.height, 1, 8192)
      if width.toLong * height > MostPixels then
        capture.fail("Height", s"at most $MostPixels pixels", s"$width × $height")
      capture.whole("ImageType", 0, -1, 99) ->
        Capture(width, height, capture.number("FOV_Degrees", unless.fovDeg, 1, 179).toFloat)
    .toMap

  private def lidar(section: SettingsSection, flies: Boolean): Lidar =
    val unless = if flies then Lidar() else Lidar(verticalFovDeg = (-10, 10))
    Lidar(
      channels = section.whole("NumberOfChannels", unless.channels, 1, 1024),
      rangeM = section.number("Range", unless.rangeM, 0.01, 100_000),
      pointsPerSecond = section.whole("PointsPerSecond", unless.pointsPerSecond, 1, 100_000_000),
      rotationsPerSecond = section.whole("RotationsPerSecond", unless.rotationsPerSecond, 1, 1000),
      horizontalFovDeg = (
        section.number("HorizontalFOVStart", unless.horizontalFovDeg._1, -360, 360),
        section.number("HorizontalFOVEnd", unless.horizontalFovDeg._2, -360, 360)
      ),
      verticalFovDeg = (
        section.number("VerticalFOVLower", unless.verticalFovDeg._1, -90, 90),
        section.number("VerticalFOVUpper", unless.verticalFovDeg._2, -90, 90)
      ),
      place = placeOf(section, downM(flies)),
      sensorFrame = section.text("DataFrame", "VehicleInertialFrame") match
        case "VehicleInertialFrame" => false
        case "SensorLocalFrame"     => true
        case other => section.fail("DataFrame", "VehicleInertialFrame or SensorLocalFrame", s"'$other'")
      ,
      noiseM = section.number("RangeNoise", 0, 0, 100),
      seed = section.number("NoiseSeed", 0, -1e15, 1e15).toLong,
      fresh = section.flag("Fresh", unless = false)
    )

  private def downM(flies: Boolean) = if flies then 0.0 else -1.0

  private def placeOf(section: SettingsSection, downM: Double = 0): Placement =
    Placement.turned(
      Vector3(section.number("X", 0), section.number("Y", 0), section.number("Z", downM)),
      section.number("Roll", 0),
      section.number("Pitch", 0),
      section.number("Yaw", 0)
    )
