package skein.airsim

import scala.util.control.NonFatal
import skein.scenario.Equipment
import skein.units.*
import ujson.{Num, Obj, Value}

/** Where a vehicle starts, which is where its own frame has its origin.
  *
  * @param startNed
  *   world, m
  * @param vehicleType
  *   in any case of letters
  * @param firstPerson
  *   whether the view is its own (`IsFpvVehicle`), which makes it the one that is meant where a call names none
  * @param armed
  *   after the start and after a reset (`DefaultVehicleState`)
  * @param sensors
  *   that are switched on, by their names
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

/** What is read of an AirSim `settings.json`: vehicles with their sensors, origin, wind and clock speed. Everything else in it is passed
  * over. `SimMode` says of what type vehicles are that name none; unlike AirSim's, a world may have vehicles of both.
  *
  * @param vehicles
  *   in the file's order
  * @param origin
  *   of the world's NED frame
  * @param text
  *   the file as it came
  */
final case class WorldSettings(
    vehicles: Vector[VehicleSettings],
    origin: GeoLocation = WorldSettings.DefaultOrigin,
    windNed: Vector3 = Vector3.Zero,
    clockSpeed: Double = 1.0,
    text: String = "{}"
):
  require(vehicles.nonEmpty, "a world needs a vehicle")

  /** The one that is meant where a call names none: of those with `IsFpvVehicle` the last by name, else the first. */
  def defaultVehicle: VehicleSettings =
    vehicles.filter(_.firstPerson).maxByOption(_.name).getOrElse(vehicles.minBy(_.name))

/** Why a `settings.json` cannot be used: `path` names the key. */
enum SettingsError:
  case NotJson(reason: String)
  case Unexpected(path: String, expected: String, found: String)

  def message: String = this match
    case NotJson(reason)                   => s"not JSON: $reason"
    case Unexpected(path, expected, found) => s"$path: expected $expected, found $found"

object WorldSettings:

  /** The default vehicle's type and name in AirSim. */
  val SimpleFlight = "SimpleFlight"

  /** The same where `SimMode` is `Car`. */
  val PhysXCar = "PhysXCar"

  private val CarMode = "Car"

  /** AirSim's default home. */
  val DefaultOrigin: GeoLocation = GeoLocation(47.641468, -122.140165, Metres(122))

  val Default: WorldSettings = WorldSettings(Vector(VehicleSettings(SimpleFlight)))

  /** Reads a `settings.json`. Without vehicles there is one, named after its type, as in AirSim. */
  def parse(text: String): Either[SettingsError, WorldSettings] =
    try
      ujson.read(text) match
        case root: Obj => Right(read(root, text))
        case other     => Left(SettingsError.Unexpected("the whole", "an object", kindOf(other)))
    catch
      case e: Misfit   => Left(e.error)
      case NonFatal(e) => Left(notJson(text, e))

  /** Where a text stopped to be JSON, and what is wrong there.
    *
    * @param mistake
    *   of `ujson`, which names the mistake in its cause, and before it the whole path to it
    */
  def notJson(text: String, mistake: Throwable): SettingsError =
    Iterator.iterate(mistake)(_.getCause).takeWhile(_ != null).take(MostCauses).collectFirst {
      case wrong: ujson.ParseException =>
        val line = text.take(wrong.index).count(_ == '\n') + 1
        s"${wrong.clue}, in line $line"
      case _: ujson.IncompleteParseException => "it ends too early"
    } match
      case Some(reason) => SettingsError.NotJson(reason)
      case None         => SettingsError.NotJson(s"${mistake.getMessage}".take(MostOfReason))

  private val MostCauses   = 16
  private val MostOfReason = 200

  /** A `settings.json` with these vehicles, and what they carry to see by. */
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

  /** Leaves the reading at the first value that does not fit. */
  final private class Misfit(val error: SettingsError) extends RuntimeException(error.message)

  private def read(root: Obj, text: String): WorldSettings =
    val unless   = sensors(root, "", "DefaultSensors", SensorKind.Default)
    val usual    = if string(root, "", "SimMode", "") == CarMode then PhysXCar else SimpleFlight
    val vehicles = section(root, "Vehicles").value.toVector.map: (name, value) =>
      vehicle(name, asObject(s"Vehicles.$name", value), usual, unless)
    val origin = section(root, "OriginGeopoint")
    WorldSettings(
      if vehicles.isEmpty then Vector(VehicleSettings(usual, vehicleType = usual)) else vehicles,
      GeoLocation(
        number(origin, "OriginGeopoint", "Latitude", DefaultOrigin.latitudeDeg),
        number(origin, "OriginGeopoint", "Longitude", DefaultOrigin.longitudeDeg),
        Metres(number(origin, "OriginGeopoint", "Altitude", DefaultOrigin.altitude.value))
      ),
      vector(section(root, "Wind"), "Wind"),
      clockSpeed(root),
      text
    )

  private def clockSpeed(root: Obj): Double =
    val speed = number(root, "", "ClockSpeed", 1.0)
    if speed > 0 then speed
    else throw Misfit(SettingsError.Unexpected("ClockSpeed", "a number above 0", speed.toString))

  private def vehicle(
      name: String,
      fields: Obj,
      usual: String,
      unless: Map[String, SensorKind]
  ): VehicleSettings =
    val path = s"Vehicles.$name"
    VehicleSettings(
      name,
      vector(fields, path),
      Radians(math.toRadians(number(fields, path, "Yaw", 0))),
      string(fields, path, "VehicleType", usual) match
        case ""   => usual
        case kind => kind
      ,
      flag(fields, path, "IsFpvVehicle", default = false),
      string(fields, path, "DefaultVehicleState", "Armed") match
        case "Armed"                 => true
        case "Inactive" | "Disarmed" => false
        case other                   =>
          val expected = "Armed, Inactive or Disarmed"
          throw Misfit(SettingsError.Unexpected(s"$path.DefaultVehicleState", expected, s"'$other'"))
      ,
      sensors(fields, path, "Sensors", unless)
    )

  /** Those listed under `key` that are enabled, and of the kinds that none is listed of, those of `unless`. Kinds that
    * are not known, which forks have, are passed over.
    */
  private def sensors(
      fields: Obj,
      path: String,
      key: String,
      unless: Map[String, SensorKind]
  ): Map[String, SensorKind] =
    val listed =
      for (name, value) <- section(fields, key, path).value.toVector yield
        val at     = s"$path.$key.$name".stripPrefix(".")
        val sensor = asObject(at, value)
        (
          name,
          SensorKind.of(number(sensor, at, "SensorType", 0)),
          flag(sensor, at, "Enabled", default = false)
        )
    unless.filterNot((_, kind) => listed.exists(_._2.contains(kind))) ++
      listed.collect { case (name, Some(kind), true) => name -> kind }

  private def vector(fields: Obj, path: String): Vector3 =
    Vector3(number(fields, path, "X", 0), number(fields, path, "Y", 0), number(fields, path, "Z", 0))

  private def number(fields: Obj, path: String, key: String, default: Double): Double =
    fields.value.get(key) match
      case Some(Num(value)) => value
      case None             => default
      case Some(other)      =>
        throw Misfit(SettingsError.Unexpected(s"$path.$key".stripPrefix("."), "a number", kindOf(other)))

  private def string(fields: Obj, path: String, key: String, default: String): String =
    fields.value.get(key) match
      case Some(ujson.Str(value)) => value
      case None                   => default
      case Some(other)            =>
        throw Misfit(SettingsError.Unexpected(s"$path.$key".stripPrefix("."), "a string", kindOf(other)))

  private def flag(fields: Obj, path: String, key: String, default: Boolean): Boolean =
    fields.value.get(key) match
      case Some(ujson.Bool(value)) => value
      case None                    => default
      case Some(other)             =>
        throw Misfit(SettingsError.Unexpected(s"$path.$key", "true or false", kindOf(other)))

  private def section(root: Obj, key: String, path: String = ""): Obj =
    root.value.get(key).fold(Obj())(asObject(s"$path.$key".stripPrefix("."), _))

  private def asObject(path: String, value: Value): Obj = value match
    case fields: Obj => fields
    case other       => throw Misfit(SettingsError.Unexpected(path, "an object", kindOf(other)))

  private def kindOf(value: Value): String = value match
    case _: Obj        => "an object"
    case _: ujson.Arr  => "an array"
    case _: ujson.Str  => "a string"
    case _: Num        => "a number"
    case _: ujson.Bool => "a boolean"
    case ujson.Null    => "null"
