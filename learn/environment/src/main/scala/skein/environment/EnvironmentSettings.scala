package skein.environment

import java.util.Locale
import scala.jdk.CollectionConverters.*
import skein.forward.{Delays, LoopTiming}
import skein.loop.{LoopKind, LoopSettings, LoopTimings}
import skein.policy.{Agent, LearnerSpace, Role}
import skein.port.Moves
import skein.scenario.{Measure, PaperDuel, Reduction, Scenarios}
import skein.settings.{FlySettings, LinkText, OutsidePolicy, PolicyFile, VehicleChoice}
import skein.units.{Expect, Span}
import skein.vehicle.SensorNoise

/** Settings of environments, in the user's terms.
  *
  * @param learners the vehicles that learn: a role of the scenario, such as `pursuer`, stands for one vehicle
  *   of the role, in the next environment the next one; its plural for all of them in one world; `all` (or
  *   `both`) for all vehicles; or names of vehicles, separated by commas
  * @param opponent a policy file or a family's name, for the evaders without a learner, or for the pursuers
  *   if an evader learns; empty: their own policies
  * @param plant see [[VehicleChoice.parse]]; empty: `reduced` at the altitude where it was identified, `drag`
  *   at others, `tilt` where a policy may climb
  * @param sensors errors of readings, see [[SensorNoise.parse]]; empty: readings are true
  * @param altitudeM altitude of all vehicles at the start; 0: that of the scenario
  * @param captureRadiusM distance that ends an episode; 0: none does
  * @param startWithinM minimum and maximum initial distance, in a random direction and with a random first
  *   heading: with two vehicles, the distance of one from the other (of the evader from the pursuer); with
  *   more, that of every vehicle from its usual start; both 0: the scenario's start
  * @param movesInFlight maximum number of unanswered moves of one vehicle
  * @param turnRateRadPerS maximum turn rate of a learner other than an evader
  * @param evaderRateRadPerS maximum turn rate of a learning evader; 0: its actions are immediate turns by up
  *   to half a turn
  * @param climbMps maximum vertical speed of learners; 0: they keep the altitude of their start
  * @param scenario the scenario whose vehicles learn
  * @param set settings of the scenario, by their keys
  * @param objective reward: a sum of the scenario's measures that are means over time, or one root mean
  *   square, over whole episodes; empty: the distance to the nearest opponent, in space if learners climb,
  *   which evaders maximise and others minimise
  */
final case class EnvironmentSettings(
    learners: String = "pursuer",
    opponent: String = "",
    loop: String = "stream",
    link: String = "vpn",
    periodMs: Double = 100,
    plant: String = "",
    sensors: String = "",
    altitudeM: Double = 0,
    episodeS: Double = 60,
    captureRadiusM: Double = 0,
    startWithinM: (Double, Double) = (0, 0),
    movesInFlight: Int = Moves.InFlight,
    turnRateRadPerS: Double = OutsidePolicy.MostTurnRadPerS,
    evaderRateRadPerS: Double = 0,
    climbMps: Double = 0,
    scenario: String = PaperDuel.Name,
    set: Map[String, String] = Map.empty,
    objective: String = ""
):
  import EnvironmentSettings.*
  import OutsidePolicy.{LeastRateRadPerS, MostRateRadPerS}

  def space: LearnerSpace = LearnerSpace(climbMps > 0)

  /** The maximum turn of a learner: rad/s since its previous decision, and rad in one instant. */
  def mostTurn(role: Role): (Double, Double) =
    if role != Role.Evader then (turnRateRadPerS, 0)
    else (evaderRateRadPerS, if evaderRateRadPerS > 0 then 0 else math.Pi)

  /** The learners of environments, in turns: those of environment n have the index n modulo the number of
    * turns.
    *
    * @return Left says what was expected and what was given
    */
  private[environment] def turns(agents: Vector[Agent]): Either[String, Vector[Vector[Int]]] =
    def ofRole(name: String) = agents.indices.filter(agents(_).role.name.equalsIgnoreCase(name)).toVector
    val names                = learners.split(',').toVector.map(_.trim)
    val places               = names.map(name => agents.indexWhere(_.name == name))
    if learners == "both" || learners == "all" then Right(Vector(agents.indices.toVector))
    else if ofRole(learners).nonEmpty then Right(ofRole(learners).map(Vector(_)))
    else if learners.endsWith("s") && ofRole(learners.init).nonEmpty then Right(Vector(ofRole(learners.init)))
    else if !places.contains(-1) && places.distinct == places then Right(Vector(places.sorted))
    else
      val roles = agents.map(_.role.name.toLowerCase(Locale.ROOT)).distinct
      Left(
        s"learners: expected one of ${roles.mkString(", ")}, all of a role (${roles.head}s), all, or " +
          s"vehicles of ${agents.map(_.name).mkString(",")}, got '$learners'"
      )

  private[environment] def opponentOf(learner: Role)(using Scenarios): Either[String, Option[PolicyFile]] =
    if opponent.isEmpty then Right(None)
    else PolicyFile.chosen(Role.opponentOf(learner), opponent).left.map("opponent: " + _).map(Some(_))

  /** The loop's timing, the link, and the vehicles at an altitude.
    *
    * @param otherwise the plant, if none is named
    */
  private[environment] def flown(
      atM: Double,
      otherwise: String,
      vehicles: Int
  )(using Scenarios): Either[String, (LoopTiming, Delays, VehicleChoice)] =
    for
      kind  <- LoopKind.parse(loop).left.map("loop: " + _)
      _     <- within("period_ms", periodMs, 1, 10_000)
      _     <- within("altitude_m", atM, 1e-3, FlySettings.MostAltitudeM)
      _     <- within("episode_s", episodeS, 1, 3600)
      _     <- within("capture_radius_m", captureRadiusM, 0, MostM)
      _     <- within("start_within_m", startWithinM._1, 0, MostM)
      _     <- within("start_within_m", startWithinM._2, startWithinM._1, MostM)
      _     <- Moves.mistake(movesInFlight).map("moves_in_flight: " + _).toLeft(())
      _     <- within("turn_rate_rad_per_s", turnRateRadPerS, LeastRateRadPerS, MostRateRadPerS)
      _     <- within("evader_rate_rad_per_s", evaderRateRadPerS, 0, MostRateRadPerS)
      _     <- within("climb_mps", climbMps, 0, MostClimbMps)
      known <- VehicleChoice.parse(if plant.nonEmpty then plant else otherwise, atM).left.map("plant: " + _)
      noise <- Expect.each(Option(sensors).filter(_.nonEmpty))(SensorNoise.parse).left.map("sensors: " + _)
      vehicle      = known.sensedBy(noise.headOption)
      loopSettings = LoopSettings
        .every(Span.ofMillis(periodMs))
        .copy(model = _ => vehicle.response.predictor, movesInFlight = movesInFlight)
      timing <- LoopTimings
        .of(kind, loopSettings)
        .toRight(
          "loop: expected paused, sequential, futures, stream or " +
            s"predictive, got '${kind.label}', which plans"
        )
      delays <- LinkText.delays(link, timing, vehicles).left.map("link: " + _)
    yield (timing, delays, vehicle)

object EnvironmentSettings:
  /** Whether rewards can add up to a measure: a mean, or a root mean square if it is alone. */
  def rewards(measure: Measure): Boolean =
    measure.reduced.exists(by => by.reduction == Reduction.Mean || by.reduction == Reduction.Rms)

  /** The distance that costs the pursuer, and earns the evader, 1 a period, m. */
  val RewardM = 10f

  /** Time after an episode's end within which every learner is due again, s, unless the readings of vehicles
    * have ended.
    */
  private[environment] val SpareS = 3.0

  private val MostM = 1000.0

  private[skein] val MostClimbMps = 50.0

  /** @return Left says what was expected and what was given */
  private[environment] def read(texts: java.util.Map[String, String]): Either[String, EnvironmentSettings] =
    texts.asScala.foldLeft[Either[String, EnvironmentSettings]](Right(EnvironmentSettings())):
      case (before, (name, text)) =>
        before.flatMap: settings =>
          def number(set: Double => EnvironmentSettings) =
            text.toDoubleOption.map(set).toRight(s"$name: expected a number, got '$text'")
          name match
            case "learners"         => Right(settings.copy(learners = text))
            case "opponent"         => Right(settings.copy(opponent = text))
            case "loop"             => Right(settings.copy(loop = text))
            case "link"             => Right(settings.copy(link = text))
            case "plant"            => Right(settings.copy(plant = text))
            case "sensors"          => Right(settings.copy(sensors = text))
            case "scenario"         => Right(settings.copy(scenario = text))
            case "objective"        => Right(settings.copy(objective = text))
            case s"set.$key"        => Right(settings.copy(set = settings.set + (key -> text)))
            case "period_ms"        => number(value => settings.copy(periodMs = value))
            case "altitude_m"       => number(value => settings.copy(altitudeM = value))
            case "episode_s"        => number(value => settings.copy(episodeS = value))
            case "capture_radius_m" => number(value => settings.copy(captureRadiusM = value))
            case "start_least_m"    =>
              number(value => settings.copy(startWithinM = (value, settings.startWithinM._2)))
            case "start_most_m" =>
              number(value => settings.copy(startWithinM = (settings.startWithinM._1, value)))
            case "moves_in_flight"       => number(value => settings.copy(movesInFlight = value.toInt))
            case "turn_rate_rad_per_s"   => number(value => settings.copy(turnRateRadPerS = value))
            case "evader_rate_rad_per_s" => number(value => settings.copy(evaderRateRadPerS = value))
            case "climb_mps"             => number(value => settings.copy(climbMps = value))
            case _                       => Left(s"no setting '$name'")

  private def within(name: String, value: Double, least: Double, most: Double): Either[String, Unit] =
    Expect.that(value >= least && value <= most)(s"$name: expected $least to $most, got $value")
