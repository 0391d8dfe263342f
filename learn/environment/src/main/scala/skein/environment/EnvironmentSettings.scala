package skein.environment

import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*
import skein.forward.{Delays, Duel, LinkDelays, LoopTiming}
import skein.lanes.{LearnerDuels, LaneDynamics}
import skein.loop.{LoopKind, LoopSettings, LoopTimings}
import skein.policy.{PaperEvader, PaperPursuer, Policy, Role}
import skein.port.Moves
import skein.scenario.{PaperDuel, Scenarios}
import skein.settings.{FlySettings, OutsidePolicy, PolicyFile, TextFile, VehicleChoice}
import skein.signal.LatencyProfile
import skein.units.{Expect, Span}

/** Settings of environments, in the user's terms.
  *
  * @param learners `pursuer`, `evader`, or `both`
  * @param opponent a policy file or a family's name; empty: the paper's. Ignored where both learn, and in
  *   other scenarios than the duel, where all vehicles without a learner use their own policies
  * @param plant see [[VehicleChoice.parse]]; empty: `reduced` in the duel, else `drag`
  * @param captureRadiusM distance that ends an episode; 0: none does
  * @param startWithinM least and greatest initial distance of the evader from the pursuer, in any direction,
  *   each commanded in any direction; both 0: the paper's start. In other scenarios: distance of every
  *   vehicle from its usual start
  * @param movesInFlight most unanswered moves of one vehicle
  * @param turnRateRadPerS greatest turn rate of a learning pursuer
  * @param evaderRateRadPerS greatest turn rate of a learning evader; 0: its actions are immediate turns of up
  *   to half a turn
  * @param scenario whose pursuer or evader learns
  * @param set settings of the scenario, by their keys
  * @param objective reward in other scenarios than the duel: a sum of means of the scenario's measures;
  *   empty: the distance to the nearest opponent
  */
final case class EnvironmentSettings(
    learners: String = "pursuer",
    opponent: String = "",
    loop: String = "stream",
    link: String = "vpn",
    periodMs: Double = 100,
    plant: String = "",
    altitudeM: Double = 20,
    episodeS: Double = 60,
    captureRadiusM: Double = 0,
    startWithinM: (Double, Double) = (0, 0),
    movesInFlight: Int = Moves.InFlight,
    turnRateRadPerS: Double = OutsidePolicy.MostTurnRadPerS,
    evaderRateRadPerS: Double = 0,
    scenario: String = PaperDuel.Name,
    set: Map[String, String] = Map.empty,
    objective: String = ""
):
  import EnvironmentSettings.*

  /** The greatest turn of a learner: rad/s until the next decision, and rad in one instant. */
  def mostTurn(role: Role): (Double, Double) =
    if role == Role.Pursuer then (turnRateRadPerS, 0)
    else (evaderRateRadPerS, if evaderRateRadPerS > 0 then 0 else math.Pi)

  /** @return Left states what was expected and what was given */
  private[environment] def resolved: Either[String, Resolved] =
    resolvedAgainst(None)(using Scenarios.ours)

  /** @param told the opponent; without one, as the settings name it */
  private[environment] def resolvedAgainst(told: Option[PolicyFile])(using
      Scenarios
  ): Either[String, Resolved] =
    for
      roles <- roles
      _     <- Expect.that(objective.isEmpty):
        "objective: expected with another scenario than the duel, " +
          s"whose distance is rewarded, came '$objective'"
      flown <- flown(altitudeM, "reduced", vehicles = 2)
      (timing, delays, vehicle) = flown
      paper                     = Duel.paperAt(altitudeM, episodeS + SpareS)
      _ <- LaneDynamics
        .isHighEnough(vehicle.response, Seq(paper.evader, paper.pursuer)).left.map("plant: " + _)
      model   <- LaneDynamics.under(timing, vehicle.response).left.map("plant: " + _)
      against <- told.fold(opponentFile(roles))(file => Right(Some(file)))
      (evader, pursuer) = against.fold((PaperEvader(), PaperPursuer())): file =>
        if file.role == Role.Pursuer then (PaperEvader(), file.policy) else (file.policy, PaperPursuer())
      _ <- Vector(evader, pursuer)
        .flatMap(LearnerDuels.refusal(_).toScala)
        .headOption
        .map("opponent: " + _)
        .toLeft(())
    yield Resolved(this, roles, evader, pursuer, paper, timing, delays, model)

  private[environment] def roles: Either[String, Vector[Role]] = Learners.get(learners).toRight(
    s"learners: expected ${Learners.keys.mkString(", ")}, came '$learners'"
  )

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
      kind    <- LoopKind.parse(loop).left.map("loop: " + _)
      _       <- within("period_ms", periodMs, 1, 10_000)
      _       <- within("altitude_m", atM, 1e-3, FlySettings.MostAltitudeM)
      _       <- within("episode_s", episodeS, 1, 3600)
      _       <- within("capture_radius_m", captureRadiusM, 0, MostM)
      _       <- within("start_within_m", startWithinM._1, 0, MostM)
      _       <- within("start_within_m", startWithinM._2, startWithinM._1, MostM)
      _       <- Moves.mistake(movesInFlight).map("moves_in_flight: " + _).toLeft(())
      _       <- within("turn_rate_rad_per_s", turnRateRadPerS, 1e-3, MostRateRadPerS)
      _       <- within("evader_rate_rad_per_s", evaderRateRadPerS, 0, MostRateRadPerS)
      vehicle <- VehicleChoice.parse(if plant.nonEmpty then plant else otherwise, atM).left.map("plant: " + _)
      delays  <- delaysOf(link, vehicles).left.map("link: " + _)
      loopSettings = LoopSettings
        .every(Span.ofMillis(periodMs))
        .copy(model = _ => vehicle.response.predictor, movesInFlight = movesInFlight)
      timing <- LoopTimings
        .of(kind, loopSettings)
        .toRight(
          "loop: expected paused, sequential, futures, stream or " +
            s"predictive, came '${kind.label}', which plans"
        )
    yield (timing, delays, vehicle)

  private def delaysOf(link: String, vehicles: Int): Either[String, Delays] =
    LatencyProfile
      .parse(link, TextFile.read)
      .left.map(_.message)
      .flatMap(LinkDelays.checked(_, LinkDelays.packetsPerS(vehicles, periodMs / 1000)))

  private def opponentFile(roles: Vector[Role]): Either[String, Option[PolicyFile]] =
    if opponent.isEmpty then Right(None)
    else if roles.size == 2 then Left(s"opponent: expected none where both sides learn, came '$opponent'")
    else
      PolicyFile
        .chosen(Role.opponentOf(roles.head), opponent)(using Scenarios.ours)
        .left
        .map("opponent: " + _)
        .map(Some(_))

object EnvironmentSettings:
  /** The distance that costs the pursuer, and earns the evader, 1 a period, m. */
  val RewardM = 10f

  /** Resolved settings. The duel lasts slightly longer than an episode: a learner that observes its end must
    * be due once more.
    */
  private[environment] final case class Resolved(
      settings: EnvironmentSettings,
      learners: Vector[Role],
      evader: Policy,
      pursuer: Policy,
      duel: Duel,
      timing: LoopTiming,
      link: Delays,
      model: LaneDynamics
  )

  private val Learners: Map[String, Vector[Role]] = Map(
    "pursuer" -> Vector(Role.Pursuer),
    "evader"  -> Vector(Role.Evader),
    "both"    -> Vector(Role.Evader, Role.Pursuer)
  )

  /** Time after an episode's end within which a learner is due again, s, unless the vehicles' readings have
    * ended.
    */
  private[environment] val SpareS = 3.0

  private val MostM = 1000.0

  private val MostRateRadPerS = 50.0

  /** @return Left states what was expected and what was given */
  private[environment] def read(texts: java.util.Map[String, String]): Either[String, EnvironmentSettings] =
    texts.asScala.foldLeft[Either[String, EnvironmentSettings]](Right(EnvironmentSettings())):
      case (before, (name, text)) =>
        before.flatMap: settings =>
          def number(set: Double => EnvironmentSettings) =
            text.toDoubleOption.map(set).toRight(s"$name: expected a number, came '$text'")
          name match
            case "learners"         => Right(settings.copy(learners = text))
            case "opponent"         => Right(settings.copy(opponent = text))
            case "loop"             => Right(settings.copy(loop = text))
            case "link"             => Right(settings.copy(link = text))
            case "plant"            => Right(settings.copy(plant = text))
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
            case _                       => Left(s"no setting '$name'")

  private def within(name: String, value: Double, least: Double, most: Double): Either[String, Unit] =
    Expect.that(value >= least && value <= most)(s"$name: expected $least to $most, came $value")
