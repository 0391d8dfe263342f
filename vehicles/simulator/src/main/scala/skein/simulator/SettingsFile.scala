package skein.simulator

import skein.airsim.{SettingsError, SettingsSection, WorldSettings}

/** An AirSim `settings.json` as the built-in simulator applies it. Each key takes effect, or is listed as
  * having none, or causes the file to be refused.
  *
  * @param ignored paths of keys without effect here, in the file's order
  */
final case class SettingsFile(world: WorldSettings, ignored: Vector[String]):

  /** One line that lists keys without effect, at most [[SettingsFile.MostTold]] of them. */
  def notice: Option[String] = Option.when(ignored.nonEmpty):
    val told = ignored.take(SettingsFile.MostTold).map(SettingsError.shown).mkString(", ")
    val more = ignored.size - SettingsFile.MostTold
    s"without effect here: $told${if more > 0 then s" and $more more" else ""}"

object SettingsFile:
  val MostTold = 20

  def read(text: String): Either[SettingsError, SettingsFile] = SettingsSection.read(text): root =>
    val world = WorldSettings.read(root, text)
    val local = localOnly(root)
    checkMode(root)
    checkWorld(root, world)
    val _ = SensorSettings.of(root, world)
    SettingsFile(world, root.unread ++ local)

  /** The notice for a file that contains a network address. The address has no effect: a file may come from
    * anyone, and whether other machines may connect is decided on the command line.
    */
  private def localOnly(root: SettingsSection): Option[String] =
    Option.when(!Loopback(root.text("LocalHostIp", "")))(
      "LocalHostIp (only this machine can connect, unless --listen says otherwise)"
    )

  private def checkMode(root: SettingsSection): Unit =
    root.number("SettingsVersion", 1.2, 1, 2): Unit
    oneOf(root, "SimMode", Modes)
    oneOf(root, "PhysicsEngineName", Engines)
    if !root.flag("RpcEnabled", unless = true) then root.fail("RpcEnabled", "true", "false")

  private def oneOf(root: SettingsSection, key: String, known: Vector[String]): Unit =
    val value = root.text(key, "")
    if value.nonEmpty && !known.contains(value) then root.fail(key, known.mkString(" or "), s"'$value'")

  /** Checks bounds within which physics stays finite and the air's formulas are valid. */
  private def checkWorld(root: SettingsSection, world: WorldSettings): Unit =
    root.number("ClockSpeed", 1, 0.001, 1000): Unit
    if world.windNed.norm > VehicleLimits.FastestWindMps then
      root.fail(
        "Wind",
        s"at most ${VehicleLimits.FastestWindMps.round} m/s",
        s"${world.windNed.norm.round} m/s"
      )
    val origin = root.section("OriginGeopoint")
    origin.number("Latitude", 0, -90, 90): Unit
    origin.number("Longitude", 0, -180, 180): Unit
    origin.number("Altitude", 0, -1000, 10_000): Unit
    if world.vehicles.size > VehicleLimits.MostVehicles then
      root.fail("Vehicles", s"at most ${VehicleLimits.MostVehicles}", world.vehicles.size.toString)
    val listed = root.section("Vehicles")
    for vehicle <- world.vehicles do
      val fields = listed.section(vehicle.name)
      if vehicle.name.isEmpty || vehicle.name.length > VehicleLimits.LongestName then
        listed.fail(
          vehicle.name,
          s"a name of 1 to ${VehicleLimits.LongestName} characters",
          s"${vehicle.name.length}"
        )
      for axis <- Seq("X", "Y", "Z") do
        fields.number(axis, 0, -VehicleLimits.FarthestM, VehicleLimits.FarthestM): Unit
      if !VehicleLimits.flies(vehicle) then
        fields.fail("VehicleType", VehicleLimits.Types.mkString(", "), s"'${vehicle.vehicleType}'")

  private val Modes    = Vector("Multirotor", "Car", "ComputerVision")
  private val Engines  = Vector("FastPhysicsEngine", "PhysX")
  private val Loopback = Set("", "127.0.0.1", "localhost")
