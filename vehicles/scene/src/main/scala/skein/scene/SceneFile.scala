package skein.scene

import com.typesafe.config.*
import java.io.File
import java.net.URL
import scala.jdk.CollectionConverters.*
import skein.signal.SplitMix64
import skein.units.Vector3

/** The reason why a scene cannot be used.
  *
  * @param place file and line, if known
  */
final case class SceneError(place: String, problem: String):
  def message: String = s"$place: $problem"

/** Reads scene files in HOCON or JSON; `docs/guides/cameras.md` lists the keys. */
object SceneFile:
  /** Names of the scenes in the distribution. */
  val Names: Vector[String] = Vector("empty", "forest", "pursuit", "street")

  val MostObjects = 2000

  /** Loads a scene of the distribution; None if there is none of this name. */
  def named(name: String): Option[Scene] = Option.when(Names.contains(name)):
    val text = String(getClass.getResourceAsStream(s"$name.conf").readAllBytes, "UTF-8")
    parse(text, s"$name.conf").fold(error => throw IllegalStateException(error.message), identity)

  /** @param from the source that error messages name */
  def parse(text: String, from: String): Either[SceneError, Scene] =
    try
      val options = ConfigParseOptions.defaults.setOriginDescription(from).setAllowMissing(false)
      val config  = ConfigFactory.parseString(text, options.setIncluder(NoIncludes(from)))
        .resolve(ConfigResolveOptions.noSystem)
      Right(read(config))
    catch
      case e: Misfit          => Left(SceneError(e.place, e.problem))
      case e: ConfigException =>
        val place = Option(e.origin).fold(from)(_.description)
        Left(SceneError(place, e.getMessage.stripPrefix(s"$place: ")))
      case _: StackOverflowError =>
        Left(SceneError(from, "its braces and brackets are nested too deeply to be read"))

  /** A scene file includes no other file and makes no request. */
  final private class NoIncludes(from: String)
      extends ConfigIncluder, ConfigIncluderFile, ConfigIncluderURL, ConfigIncluderClasspath:
    private def refuse(what: Any): Nothing = throw Misfit(from, s"a scene includes no other file: $what")

    def withFallback(other: ConfigIncluder): ConfigIncluder                         = this
    def include(context: ConfigIncludeContext, what: String): ConfigObject          = refuse(what)
    def includeFile(context: ConfigIncludeContext, what: File): ConfigObject        = refuse(what)
    def includeURL(context: ConfigIncludeContext, what: URL): ConfigObject          = refuse(what)
    def includeResources(context: ConfigIncludeContext, what: String): ConfigObject = refuse(what)

  final private class Misfit(val place: String, val problem: String)
      extends RuntimeException(problem, null, false, false)

  private def fail(where: ConfigValue | Config, problem: String): Nothing =
    val origin = where match
      case value: ConfigValue => value.origin
      case config: Config     => config.root.origin
    throw Misfit(origin.description, problem)

  private def read(config: Config): Scene =
    only(config, "ground", "sky", "vehicle-tag-m", "objects", "scatter")
    val stated    = list(config, "objects").zipWithIndex.map((entry, index) => thing(entry, index + 1))
    val scattered = list(config, "scatter").flatMap(scatter)
    val all       = stated ++ scattered
    if all.size > MostObjects then fail(config, s"at most $MostObjects objects are drawn, not ${all.size}")
    val twice = all.groupBy(_.name).collectFirst { case (name, same) if same.size > 1 => name }
    for name <- twice do fail(config, s"two objects are named $name")
    if all.exists(_.name == Scene.Ground) then fail(config, s"${Scene.Ground} is the ground's name")
    Scene(
      all,
      colour(config, "ground", Scene.Empty.groundRgb),
      colour(config, "sky", Scene.Empty.skyRgb),
      number(config, "vehicle-tag-m", Some(0), 0, 10)
    )

  private val Common = Seq("name", "id", "colour", "at", "yaw-deg", "pitch-deg", "roll-deg")

  private def thing(entry: Config, index: Int): SceneObject =
    val kinds = Seq("box", "pole", "wall", "tag").filter(entry.hasPath)
    kinds match
      case Seq("box") =>
        only(entry, Common :+ "box"*)
        val lengths = numbers(entry, "box", 3)
        if lengths.exists(_ <= 0) then fail(entry.getValue("box"), "box: expected three lengths above 0, m")
        val shape = Shape.Box(Vector3(lengths(0), lengths(1), lengths(2)) * 0.5)
        made(entry, "Box", index, shape, place(entry, lengths(2) / 2), 0x9a8f80)
      case Seq("pole") =>
        only(entry, Common ++ Seq("pole")*)
        val Seq(radius, height) = numbers(entry, "pole", 2): @unchecked
        if radius <= 0 || height <= 0 then
          fail(entry.getValue("pole"), "pole: expected radius and height above 0, m")
        made(entry, "Pole", index, Shape.Pole(radius, height / 2), place(entry, height / 2), 0x6b4f3a)
      case Seq("wall") =>
        only(entry, "name", "id", "colour", "wall", "height-m", "thickness-m")
        val Seq(n0, e0, n1, e1) = numbers(entry, "wall", 4): @unchecked
        val length              = math.sqrt((n1 - n0) * (n1 - n0) + (e1 - e0) * (e1 - e0))
        if length == 0 then fail(entry.getValue("wall"), "wall: expected two places apart from one another")
        val height    = number(entry, "height-m", None, 0.01, 1000)
        val thickness = number(entry, "thickness-m", Some(0.2), 0.001, 1000)
        val place     = Placement.turned(
          Vector3((n0 + n1) / 2, (e0 + e1) / 2, -height / 2),
          0,
          0,
          StrictMath.toDegrees(StrictMath.atan2(e1 - e0, n1 - n0))
        )
        made(entry, "Wall", index, Shape.Box(Vector3(length, thickness, height) * 0.5), place, 0xb8a088)
      case Seq("tag") =>
        only(entry, Common ++ Seq("tag", "side-m")*)
        val tag = number(entry, "tag", None, 0, AprilTag.count - 1)
        if tag != tag.toInt then fail(entry.getValue("tag"), "tag: expected a whole number")
        val side = number(entry, "side-m", Some(0.5), 0.001, 100)
        made(entry, s"Tag", index, Shape.Tag(tag.toInt, side), place(entry, 0), 0xffffff)
      case _ =>
        val came = if kinds.nonEmpty then kinds.mkString(" and ")
        else entry.root.keySet.asScala.toVector.sorted.mkString(", ")
        fail(
          entry,
          s"expected one of box, pole, wall or tag, got ${if came.isEmpty then "nothing" else came}"
        )

  private def made(
      entry: Config,
      kind: String,
      index: Int,
      shape: Shape,
      place: Placement,
      unless: Int
  ): SceneObject =
    val name = if entry.hasPath("name") then entry.getString("name") else s"$kind$index"
    if name.isEmpty || name.length > 100 then fail(entry, "name: expected 1 to 100 characters")
    val id = Option.when(entry.hasPath("id"))(number(entry, "id", None, 0, 255).toInt)
    SceneObject(name, shape, place, colour(entry, "colour", unless), id)

  /** The place of an object of this half height: on the ground, unless `at` has a third number. */
  private def place(entry: Config, halfM: Double): Placement =
    val at   = numbers(entry, "at", 3, least = 2)
    val down = if at.size == 3 then at(2) else 0.0
    Placement.turned(
      Vector3(at(0), at(1), down - halfM),
      number(entry, "roll-deg", Some(0), -360, 360),
      number(entry, "pitch-deg", Some(0), -360, 360),
      number(entry, "yaw-deg", Some(0), -360, 360)
    )

  /** Poles at positions drawn from a seed, with distances between each other and to places to keep clear. */
  private def scatter(entry: Config): Vector[SceneObject] =
    only(entry, "name", "colour", "count", "seed", "within", "radius-m", "height-m", "apart-m", "clear")
    val name           = if entry.hasPath("name") then entry.getString("name") else "Pole"
    val count          = number(entry, "count", None, 1, MostObjects).toInt
    val rgb            = colour(entry, "colour", 0x6b4f3a)
    val within         = numbers(entry, "within", 4)
    val Seq(thin, fat) = numbers(entry, "radius-m", 2): @unchecked
    val Seq(low, high) = numbers(entry, "height-m", 2): @unchecked
    val apart          = number(entry, "apart-m", Some(0), 0, 1000)
    val clear          = list(entry, "clear", (value, key) => numbersOf(value, key, 3))
    if thin <= 0 || low <= 0 then fail(entry, "radius-m and height-m: expected numbers above 0")
    val random                      = SplitMix64(number(entry, "seed", None, 0, 1e15).toLong)
    def among(a: Double, b: Double) = a + (b - a) * random.nextDouble()
    var placed                      = Vector.empty[(Double, Double, Double)]
    var tries                       = 0
    while placed.size < count do
      tries += 1
      if tries > 1000 * count then fail(entry, s"no room for $count poles: ${placed.size} fit")
      val (north, east)             = (among(within(0), within(2)), among(within(1), within(3)))
      def far(n: Double, e: Double) = math.sqrt((n - north) * (n - north) + (e - east) * (e - east))
      if placed.forall((n, e, _) => far(n, e) >= apart) && clear.forall(c => far(c(0), c(1)) >= c(2)) then
        placed = placed :+ (north, east, among(thin, fat))
    placed.zipWithIndex.map: (tree, index) =>
      val (north, east, radius) = tree
      val half                  = among(low, high) / 2
      SceneObject(
        s"$name${index + 1}",
        Shape.Pole(radius, half),
        Placement(Vector3(north, east, -half)),
        rgb,
        None
      )

  private def only(config: Config, keys: String*): Unit =
    for entry <- config.root.entrySet.asScala if !keys.contains(entry.getKey) do
      fail(entry.getValue, s"no key ${entry.getKey}; there are ${keys.mkString(", ")}")

  private def list(config: Config, key: String): Vector[Config] = list(
    config,
    key,
    (value, _) =>
      value match
        case entry: ConfigObject => entry.toConfig
        case other               => fail(other, s"$key: expected an object in braces")
  )

  private def list[A](config: Config, key: String, read: (ConfigValue, String) => A): Vector[A] =
    if !config.hasPath(key) then Vector.empty
    else
      config.getValue(key) match
        case values: ConfigList => values.asScala.toVector.map(read(_, key))
        case other              => fail(other, s"$key: expected a list in brackets")

  private def number(
      config: Config,
      key: String,
      unless: Option[Double],
      least: Double,
      most: Double
  ): Double =
    if !config.hasPath(key) then unless.getOrElse(fail(config, s"$key is missing"))
    else
      val value = numberOf(config.getValue(key), key)
      if value >= least && value <= most then value
      else fail(config.getValue(key), s"$key: expected a number from $least to $most, got $value")

  private def numbers(config: Config, key: String, count: Int, least: Int = -1): Vector[Double] =
    if !config.hasPath(key) then fail(config, s"$key is missing")
    numbersOf(config.getValue(key), key, count, least)

  private def numbersOf(value: ConfigValue, key: String, count: Int, least: Int = -1): Vector[Double] =
    value match
      case values: ConfigList
          if values.size <= count && values.size >= (if least < 0 then count else least) =>
        values.asScala.toVector.map(numberOf(_, key))
      case other => fail(other, s"$key: expected $count numbers in brackets")

  private def numberOf(value: ConfigValue, key: String): Double =
    value.unwrapped match
      case number: Number if value.valueType == ConfigValueType.NUMBER && number.doubleValue.abs <= 1e15 =>
        number.doubleValue
      case other => fail(value, s"$key: expected a number, got $other")

  private def colour(config: Config, key: String, unless: Int): Int =
    if !config.hasPath(key) then unless
    else
      config.getValue(key).unwrapped match
        case text: String if text.matches("#[0-9a-fA-F]{6}") => Integer.parseInt(text.drop(1), 16)
        case other => fail(config.getValue(key), s"$key: expected a colour such as \"#6b7f4f\", got $other")
