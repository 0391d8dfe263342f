package skein.cli

import com.typesafe.config.{Config, ConfigException, ConfigFactory, ConfigValueFactory}
import mainargs.{Flag, ParserForClass, arg}
import scala.compiletime.constValueTuple
import scala.deriving.Mirror
import scala.jdk.CollectionConverters.*
import scala.util.Try
import skein.loop.{AnyLoop, Fallback, LoopKind, OpponentModel, Planning}
import skein.scenario.Scenarios
import skein.settings.{ConfigKeys, ConfigMistakes, FlySettings, HoconFile, ScenarioSettings, Wire}
import skein.units.Expect

/** Options of the flights to fly; options that are not given are read from the configuration `skein.fly`. */
final case class FlightOptions(
    @arg(doc =
      "paused, sequential, futures, stream, predictive, plan, or a loop of the program's own; can be repeated"
    )
    loop: Seq[String],
    @arg(doc =
      "a latency profile: none, direct, vpn, vpn-mixed, constant:200ms, …; can be repeated"
    )
    link: Seq[String],
    @arg(doc = "length of each flight, for example 60s")
    duration: Option[String],
    @arg(doc = "time between decisions for one vehicle, for example 100ms")
    period: Option[String],
    @arg(doc = "seed of every random choice")
    seed: Option[Long],
    @arg(doc = "the scenario to fly; the command scenarios lists them with their settings")
    scenario: Option[String],
    @arg(doc = "a setting of the scenario, for example ring-m=10; can be repeated")
    set: Seq[String],
    @arg(doc =
      "scene of the built-in simulator: empty, forest, pursuit, street, or a file; without it, the scenario's"
    )
    scene: Option[String],
    @arg(doc = "the scenario's setting vehicles")
    vehicles: Option[Int],
    @arg(doc =
      "flies the scenario with this policy too, beside its own policies: a policy file " +
        "of the commands search and learn, an ONNX file (evader:FILE.onnx for an " +
        "evader's), or unix:ROLE:PATH for a policy behind a socket; can be repeated"
    )
    policy: Seq[String],
    @arg(
      name = "only-policies",
      doc = "flies with the policies of --policy alone, and not by the scenario's own beside them"
    )
    onlyPolicies: Flag,
    @arg(doc = "the duel's setting pairs: duels side by side, two vehicles each")
    pairs: Option[Int],
    @arg(name = "as-paper", doc = "the paper's four loops alone, without predictive")
    asPaper: Flag,
    @arg(
      name = "as-published",
      doc =
        "the duel's setting as-published: reproduces the published code, whose turn rate depends on the loop"
    )
    asPublished: Flag,
    @arg(doc =
      "the scenario's setting altitude-m: the altitude of all vehicles above their starts, in metres"
    )
    altitude: Option[Double],
    @arg(doc =
      "model that flies in the built-in simulator: airsim, airsim:DEVIATION such as " +
        "airsim:mass=1.3,drag=2,wind=8/0/0, or mujoco:FILE"
    )
    plant: Option[String],
    @arg(doc =
      "errors of the vehicles' readings, such as position=0.1,dropout=2%: position, velocity, heading (standard " +
        "deviations in m, m/s, rad), drift=1.5/60s (of the position, slowly varying), dropout, outage=1s/20s; with " +
        "--simulator, those of its serve --sensors"
    )
    sensors: Option[String],
    @arg(doc =
      "model that predicts, in `predictive` and `plan`: reduced, drag, quadrotor, constant-velocity, " +
        "constant-turn, adaptive, a model file of `skein identify`, or reduced:FILE for its model of three parameters"
    )
    predictor: Option[String],
    @arg(
      name = "moves-in-flight",
      doc =
        "unanswered moves of one vehicle; over a long round trip, more moves carry more " +
          "commands, but several that a stall delivers at once can freeze AirSim"
    )
    movesInFlight: Option[Int],
    @arg(
      name = "plan-in-packet",
      doc =
        "each command of `predictive` carries its plan for the next moments: a buffer beside the vehicle " +
          "performs what is due, through delays and losses; the built-in simulator has one, and link --buffer"
    )
    planInPacket: Flag,
    @arg(doc =
      "what a vehicle's controller knows of the others: all, or positions, their readings alone, without " +
        "their commands and policies"
    )
    knows: Option[String],
    @arg(doc =
      "how `predictive` predicts vehicles whose commands it does not know: turn (their last turn goes on), " +
        "straight, or belief (samples of turns, weighted by what is seen)"
    )
    strangers: Option[String],
    @arg(doc =
      "gives each vehicle a controller of its own, with a link of its own, that knows of the others what it reads"
    )
    decentralised: Flag,
    @arg(doc =
      "with --decentralised and fly --simulator: flies this vehicle alone, beside processes that fly the others"
    )
    only: Option[String],
    @arg(doc =
      "with --decentralised: controllers read their own vehicles alone, and send one another what they read over " +
        "a link of this profile, such as range:60m,loss:10%/4,constant:40ms"
    )
    between: Option[String],
    @arg(doc = "deadline of each decision, for example 20ms; without it, the loop waits for policies")
    deadline: Option[String],
    @arg(doc =
      "what happens when the deadline is missed: hold, repeat (the last decision), " +
        "hover, or a policy such as pure-pursuit; with --solver, hover by default"
    )
    fallback: Option[String],
    @arg(doc =
      "flies each loop but paused also with decisions made elsewhere: tcp://HOST:PORT of ./skein decide, " +
        "kafka://HOST:PORT/PREFIX of one behind a broker, or in virtual time link:PROFILE, a " +
        "profile of round trips; the deadline of a decision is then the period by default"
    )
    solver: Option[String],
    @arg(doc =
      "speaks MAVLink to the vehicles, as to PX4; the scenario's first vehicle is system 1; not for paused"
    )
    mavlink: Flag,
    @arg(doc =
      "records images and scans: seen, those that policies use, or CAMERA@HZ, images of " +
        "that camera of every vehicle, for example front_center@10; can be repeated"
    )
    images: Seq[String],
    @arg(doc = "a HOCON file with settings of skein.fly")
    config: Option[String]
):

  /** The settings: flags take precedence over the file, the file over defaults. */
  def settings(using Scenarios): Either[String, FlySettings] = settingsOf(mayPause = true)

  /** @param mayPause whether the vehicles' time can be stopped, as far as known to the command */
  private[cli] def settingsOf(mayPause: Boolean)(using Scenarios): Either[String, FlySettings] =
    configurationOf(mayPause).flatMap(FlySettings.read).map: settings =>
      if settings.loops.contains(LoopKind.Plan) then
        (Planning.told(settings.fleet).toOption ++ OpponentModel.missing(settings.fleet))
          .foreach(Console.err.println)
      settings

  /** The merged configuration before it is read: all of `skein.fly`. */
  def configuration(using Scenarios): Either[String, Config] = configurationOf(mayPause = true)

  private def configurationOf(mayPause: Boolean)(using Scenarios): Either[String, Config] =
    ConfigMistakes.guarded("--config")(merged(mayPause))

  private def merged(mayPause: Boolean)(using Scenarios): Either[String, Config] =
    for
      _ <- Expect.that(loop.isEmpty || !asPaper.value):
        s"--as-paper flies the paper's loops: expected no --loop beside it, got ${loop.mkString(", ")}"
      file <- config.fold(Right(ConfigFactory.empty))(FlightOptions.read)
      told = flags.withFallback(file).withFallback(ConfigFactory.load()).resolve()
      merged <- FlightOptions.scenarioRead(FlightOptions.hovering(looping(told, mayPause)))
      _      <- ConfigMistakes.ofShape(merged, "skein.fly").toLeft(())
      own    <- ofScenario(merged)
    yield own.withFallback(merged).withOnlyPath("skein.fly")

  /** The configuration with loops that do not stop the vehicles' time, if none was chosen and that time
    * cannot be stopped here.
    */
  private def looping(told: Config, mayPause: Boolean): Config =
    val wire     = Try(told.getString("skein.fly.wire")).toOption
    val isOurs   = mayPause && !told.hasPath("skein.fly.only") && !wire.contains(Wire.Mavlink.label)
    val isChosen = loop.nonEmpty || ConfigMistakes.isGiven("skein.fly.loops", told) && !asPaper.value
    if isOurs || isChosen then told
    else
      val loops = FlightOptions.paperLoops ++ Option.when(!asPaper.value)(LoopKind.Predictive.label)
      val named = ConfigValueFactory.fromIterable(loops.filterNot(_ == LoopKind.Paused.label).asJava)
      told.withValue("skein.fly.loops", named)

  /** Each option whose field is a setting of `skein.fly`. */
  private def flags: Config =
    val told = if loop.isEmpty && asPaper.value then copy(loop = FlightOptions.paperLoops) else this
    val set  =
      for
        (field, option) <- told.productElementNames.zip(told.productIterator).toSeq
        key             <- FlightOptions.keyOf(field)
        value           <- option match
          case Some(one)                           => Some(one)
          case Flag(isSet)                         => Option.when(isSet)(true)
          case several: Seq[?] if several.nonEmpty => Some(several.asJava)
          case _                                   => None
      yield (FlightOptions.flagOf(field), key, value)
    FlightOptions.configured(set ++ Option.when(mavlink.value)(("--mavlink", "wire", Wire.Mavlink.label)))

  /** Adds the flags for settings of the chosen scenario. */
  private def ofScenario(merged: Config)(using Scenarios): Either[String, Config] =
    val short = Seq(
      "vehicles"     -> ("--vehicles", vehicles),
      "pairs"        -> ("--pairs", pairs),
      "altitude-m"   -> ("--altitude", altitude),
      "as-published" -> ("--as-published", Option.when(asPublished.value)(true))
    ).collect { case (key, (flag, Some(value))) => (flag, key, value.toString) }
    for
      kind <- ScenarioSettings.kind(merged)
      told <- Arguments.settings(set).map(_.map((key, value) => ("--set", key, value)))
      keys = kind.settings.map(ConfigKeys.ofField)
      _ <- Expect.all((short ++ told).groupBy(_._2).values.filter(_.sizeIs > 1).toVector): twice =>
        Left(s"${twice.map((flag, _, _) => flag).mkString(" and ")}: expected '${twice.head._2}' once, " +
          s"got ${twice.map((_, _, value) => value).mkString(" and ")}")
      known <- Expect.all(short ++ told): (flag, key, value) =>
        Either.cond(
          keys.contains(key),
          (if flag == "--set" then s"--set $key" else flag, s"${kind.name}.$key", value),
          s"$flag: the scenario ${kind.name} has no setting '$key'; expected one of ${keys.mkString(", ")}"
        )
    yield FlightOptions.configured(known)

object FlightOptions:
  /** Replaces the name of a scenario's file by its text. */
  private def scenarioRead(config: Config): Either[String, Config] =
    val path = ConfigKeys.Scenario
    if !ConfigKeys.hasText(config, path) then Right(config)
    else
      val told = config.getValue(path)
      ScenarioSettings
        .named(config.getString(path))
        .left
        .map(mistake => s"${ConfigMistakes.at(path, told.origin)}: $mistake")
        .map(text => config.withValue(path, ConfigValueFactory.fromAnyRef(text).withOrigin(told.origin)))

  given ParserForClass[FlightOptions] = ParserForClass[FlightOptions]

  /** Defaults by flag name, from the configuration. */
  lazy val defaults: Map[String, String] =
    val own = ConfigFactory.defaultReference().getConfig("skein.fly")
    val of  =
      for
        field <- fields
        key   <- keyOf(field) if own.hasPath(key)
        value <- own.getAnyRef(key) match
          case several: java.util.List[?] => Some(several.asScala.mkString(", ")).filter(_.nonEmpty)
          case _: java.lang.Boolean       => None
          case one                        => Some(one.toString.replace(" ", ""))
      yield flagOf(field).stripPrefix("--") -> value
    of.toMap

  private val mirror = summon[Mirror.ProductOf[FlightOptions]]

  private def fields: List[String] = constValueTuple[mirror.MirroredElemLabels].toList.map(_.toString)

  private def flagOf(field: String): String = "--" + ConfigKeys.ofField(field)

  /** The key below `skein.fly` that a field sets; absent if the field is the scenario's, or stands for
    * others.
    */
  private def keyOf(field: String): Option[String] = field match
    case "loop" | "link"                                                      => Some(s"${field}s")
    case "policy"                                                             => Some("policies")
    case "set" | "vehicles" | "pairs" | "altitude" | "asPublished" | "config" => None
    case "asPaper" | "mavlink"                                                => None
    case _ => Some(ConfigKeys.ofField(field))

  /** All values of flags with a known set of values, by flag name. */
  def known(using Scenarios): Map[String, Seq[String]] = Map("loop" -> AnyLoop.names)

  private val paperLoops =
    Seq(LoopKind.Paused, LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream).map(_.label)

  /** Makes a configuration of flags, keys below `skein.fly`, and values: mistakes in these name the flag. */
  private def configured(values: Seq[(String, String, Any)]): Config =
    values.foldLeft(ConfigFactory.empty):
      case (config, (flag, key, value)) =>
        config.withValue(s"skein.fly.$key", ConfigValueFactory.fromAnyRef(value, flag))

  /** Makes a vehicle hover while its solver is silent, unless the configuration chooses otherwise. */
  private def hovering(told: Config): Config =
    def says(key: String) = ConfigMistakes.isGiven(s"skein.fly.$key", told)
    if !says("solver") || says("fallback") then told
    else configured(Seq(("--fallback", "fallback", Fallback.Hover.label))).withFallback(told)

  private def read(path: String): Either[String, Config] =
    for
      file <- HoconFile.read(path).left.map("--config: " + _)
      _    <- beside(file).toLeft(())
    yield file

  /** Finds keys outside `skein.fly`; a file with unresolved substitutions is not checked yet. */
  private def beside(file: Config): Option[String] =
    try ConfigMistakes.besideInFile(file, "skein.fly")
    catch case _: ConfigException.NotResolved => None
