package skein.airsim

import skein.scenario.Equipment
import skein.units.*
import ujson.Obj

/** A vehicle's settings. Its start is the origin of its own frame.
  *
  * @param startNed position of the start, world, m
  * @param vehicleType kind of vehicle, by AirSim's name, in any letter case
  * @param firstPerson whether the view is its own (`IsFpvVehicle`), which makes it the default vehicle of
  *   calls that name none
  * @param armed whether it is armed after the start and after a reset (`DefaultVehicleState`)
  * @param sensors the sensors that are switched on, keyed by name
  */
final case class VehicleSettings(
    name: String,
    startNed: Vector3 = Vector3.Zero,
    yaw: Radians = Radians(0),
    vehicleType: String = WorldSettings.SimpleFlight,
    firstPerson: Boolean = false,
    armed: Boolean = true,
    sensors: Map[String, SensorKind] = SensorKind.Default
):
  def isCar: Boolean = vehicleType.equalsIgnoreCase(WorldSettings.PhysXCar)

  /** Whether this is a fixed camera and not a vehicle. */
  def isCamera: Boolean = vehicleType.equalsIgnoreCase(WorldSettings.ComputerVision)

  def isMultirotor: Boolean = !isCar && !isCamera

/** The part of an AirSim `settings.json` that is read: vehicles with their sensors, origin, wind and clock
  * speed. Everything else in it is ignored. `SimMode` is the type of vehicles that name none; unlike
  * AirSim's, a world may have vehicles of several types. Vehicles with `AutoCreate` false are left out.
  *
  * @param vehicles the vehicles, in the file's order
  * @param origin geographic origin of the world's NED frame
  * @param text the file's text, unchanged
  * @param defaultSensors `DefaultSensors`, also for vehicles that are added later (`simAddVehicle`)
  * @param apiPort `ApiServerPort`
  */
final case class WorldSettings(
    vehicles: Vector[VehicleSettings],
    origin: GeoLocation = WorldSettings.DefaultOrigin,
    windNed: Vector3 = Vector3.Zero,
    clockSpeed: Double = 1.0,
    text: String = "{}",
    defaultSensors: ListedSensors = ListedSensors(),
    apiPort: Option[Int] = None
):
  require(vehicles.nonEmpty, "a world needs a vehicle")

  /** The vehicle for calls that name none: of the vehicles with `IsFpvVehicle` the last by name, else the
    * first vehicle.
    */
  def defaultVehicle: VehicleSettings =
    vehicles.filter(_.firstPerson).maxByOption(_.name).getOrElse(vehicles.minBy(_.name))

object WorldSettings:

  /** The default vehicle's type and name in AirSim. */
  val SimpleFlight = "SimpleFlight"

  /** AirSim's vehicle type if `SimMode` is `Car`. */
  val PhysXCar = "PhysXCar"

  /** AirSim's vehicle type if `SimMode` is `ComputerVision`. */
  val ComputerVision = "ComputerVision"

  private val CarMode = "Car"

  /** The sensors of a vehicle of this type whose settings name none, as in AirSim: a car has a GPS, a camera
    * nothing.
    */
  def usualSensors(vehicleType: String): Map[String, SensorKind] =
    if vehicleType.equalsIgnoreCase(PhysXCar) then Map("gps" -> SensorKind.Gps)
    else if vehicleType.equalsIgnoreCase(ComputerVision) then Map.empty
    else SensorKind.Default

  /** AirSim's default home, in degrees and m above the sea. */
  val DefaultOrigin: GeoLocation = GeoLocation(47.641468, -122.140165, Metres(122))

  val Default: WorldSettings = WorldSettings(Vector(VehicleSettings(SimpleFlight)))

  /** Reads a `settings.json`. A file without vehicles yields one vehicle, named after its type, as in AirSim.
    */
  def parse(text: String): Either[SettingsError, WorldSettings] = SettingsSection.read(text)(read(_, text))

  /** The world of these vehicles with their cameras and lidars; its `text` is their `settings.json`. */
  def of(vehicles: Vector[VehicleSettings], equipment: Seq[Equipment] = Nil): WorldSettings =
    WorldSettings(vehicles, text = render(vehicles, equipment))

  /** Writes a `settings.json` with these vehicles and their cameras and lidars. */
  def render(vehicles: Seq[VehicleSettings], equipment: Seq[Equipment] = Nil): String =
    val entries = vehicles.map: vehicle =>
      val carried = equipment.filter(_.vehicle == vehicle.name)
      val entry   = Obj(
        "VehicleType" -> vehicle.vehicleType,
        "X"           -> vehicle.startNed.x,
        "Y"           -> vehicle.startNed.y,
        "Z"           -> vehicle.startNed.z,
        "Yaw"         -> math.toDegrees(vehicle.yaw.value)
      )
      val sensors = carried.collect { case lidar: Equipment.Lidar => lidar.name -> rendered(lidar) }
      val cameras = carried.collect { case camera: Equipment.Camera => camera.name -> rendered(camera) }
      if sensors.nonEmpty then entry("Sensors") = Obj.from(sensors)
      if cameras.nonEmpty then entry("Cameras") = Obj.from(cameras)
      vehicle.name -> entry
    val mode = if vehicles.nonEmpty && vehicles.forall(_.isCar) then CarMode else "Multirotor"
    Obj("SettingsVersion" -> 1.2, "SimMode" -> mode, "Vehicles" -> Obj.from(entries)).render(2)

  private def rendered(lidar: Equipment.Lidar): Obj = Obj(
    "SensorType"         -> SensorKind.Lidar.number,
    "Enabled"            -> true,
    "NumberOfChannels"   -> lidar.channels,
    "PointsPerSecond"    -> lidar.pointsPerSecond,
    "RotationsPerSecond" -> lidar.rotationsPerSecond,
    "Range"              -> lidar.rangeM,
    "VerticalFOVLower"   -> lidar.verticalFovDeg._1,
    "VerticalFOVUpper"   -> lidar.verticalFovDeg._2,
    "DataFrame"          -> "SensorLocalFrame"
  )

  private def rendered(camera: Equipment.Camera): Obj = Obj(
    "CaptureSettings" -> ujson.Arr(
      Obj(
        "ImageType"   -> ImageKind.Scene.number,
        "Width"       -> camera.width,
        "Height"      -> camera.height,
        "FOV_Degrees" -> camera.fovDeg
      )
    )
  )

  private[skein] def read(root: SettingsSection, text: String): WorldSettings =
    val shared = sensors(root.sections("DefaultSensors"))
    val usual  = root.text("SimMode", "") match
      case CarMode        => PhysXCar
      case ComputerVision => ComputerVision
      case _              => SimpleFlight
    val listed   = root.sections("Vehicles")
    val vehicles = created(listed).map((name, fields) => vehicle(name, fields, usual, shared))
    if listed.nonEmpty && vehicles.isEmpty then
      root.fail("Vehicles", "at least one without AutoCreate false", "none")
    val origin = root.section("OriginGeopoint")
    WorldSettings(
      if listed.isEmpty then
        Vector(VehicleSettings(
          usual,
          vehicleType = usual,
          sensors = shared.over(usualSensors(usual))
        ))
      else vehicles,
      GeoLocation(
        origin.number("Latitude", DefaultOrigin.latitudeDeg),
        origin.number("Longitude", DefaultOrigin.longitudeDeg),
        Metres(origin.number("Altitude", DefaultOrigin.altitude.value))
      ),
      root.section("Wind").vector,
      clockSpeed(root),
      text,
      shared,
      Option.when(root.has("ApiServerPort"))(root.whole("ApiServerPort", 0, 1, 65535))
    )

  /** The listed vehicles that exist from the start. */
  private[skein] def created(listed: Vector[(String, SettingsSection)]): Vector[(String, SettingsSection)] =
    listed.filter: (_, fields) =>
      val created = fields.flag("AutoCreate", unless = true)
      if !created then fields.switchedOff()
      created

  private def clockSpeed(root: SettingsSection): Double =
    val speed = root.number("ClockSpeed", 1.0)
    if speed > 0 then speed else root.fail("ClockSpeed", "a number above 0", speed.toString)

  private def vehicle(
      name: String,
      fields: SettingsSection,
      usual: String,
      shared: ListedSensors
  ): VehicleSettings =
    val vehicleType = fields.text("VehicleType", usual) match
      case ""   => usual
      case kind => kind
    VehicleSettings(
      name,
      fields.vector,
      Radians(math.toRadians(fields.number("Yaw", 0))),
      vehicleType,
      fields.flag("IsFpvVehicle", unless = false),
      fields.text("DefaultVehicleState", "Armed") match
        case "Armed"                 => true
        case "Inactive" | "Disarmed" => false
        case other => fields.fail("DefaultVehicleState", "Armed, Inactive or Disarmed", s"'$other'")
      ,
      sensors(fields.sections("Sensors")).over(shared.over(usualSensors(vehicleType)))
    )

  /** Unknown kinds, which forks have, count as not read. */
  private def sensors(all: Vector[(String, SettingsSection)]): ListedSensors =
    val listed =
      for (name, sensor) <- all yield
        val kind    = SensorKind.of(sensor.number("SensorType", 0))
        val enabled = sensor.flag("Enabled", unless = false)
        if !enabled then sensor.switchedOff() else if kind.isEmpty then sensor.passedOver()
        (name, kind, enabled)
    ListedSensors(
      listed.flatMap(_._2).toSet,
      listed.collect { case (name, Some(kind), true) => name -> kind }.toMap
    )
