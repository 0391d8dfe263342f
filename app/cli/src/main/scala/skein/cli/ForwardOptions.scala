package skein.cli

import mainargs.{ParserForClass, arg}
import skein.policy.Role
import skein.port.Moves
import skein.scenario.{PaperDuel, Scenario, ScenarioText, Scenarios}
import skein.search.Conditions
import skein.settings.{PolicyFile, ScenarioSettings}
import skein.units.{Expect, Span}

/** Options of forward simulation, for commands that use nothing else. */
final case class ForwardOptions(
    @arg(doc =
      "the objective: last10s, mean, min, effort, capture(RADIUS_M, WITHIN_S), captureTime(RADIUS_M), or a " +
        "weighted sum such as '0.7*last10s + 0.3*effort'; 'minimise' " +
        "or 'maximise' may precede it (default: last10s; of a scenario, a sum of its measures: expected in search " +
        "and learn, by default the first in budget)"
    )
    objective: Option[String],
    @arg(doc = "paused, sequential, futures, stream or predictive (default: stream)")
    loop: Option[String],
    @arg(
      name = "moves-in-flight",
      doc =
        "unanswered moves of one vehicle; over a long round trip, more moves carry more commands (default: 2)"
    )
    movesInFlight: Option[Int],
    @arg(doc =
      "model that flies: reduced, drag, tilt, quadrotor, quadrotor:mass=1.3,drag=2,lag=1.5 (tilt: likewise), ideal, car, mujoco:FILE, a FILE of ./skein identify, or " +
        "reduced:FILE for its model of three parameters (default: reduced; of a scenario drag, or in search and budget " +
        "tilt or quadrotor where its vehicles climb)"
    )
    plant: Option[String],
    @arg(doc =
      "errors of the vehicles' readings, such as position=0.1,dropout=2%: position, velocity, heading (standard " +
        "deviations in m, m/s, rad), drift=1.5/60s, dropout, outage=1s/20s"
    )
    sensors: Option[String],
    @arg(doc =
      "altitude of all vehicles, in metres (default: 20); a fitted model holds at the altitude of its flights"
    )
    altitude: Option[Double],
    @arg(doc =
      "for search and budget alone, a sensor's FILE of ./skein identify: the " +
        "pursuer knows the evader by this camera alone (default: true positions)"
    )
    eye: Option[String],
    @arg(doc = "the opponent's policy: a policy file or the name of a family (default: the paper's)")
    opponent: Option[String],
    @arg(doc = "length of an episode (default: the scenario's own, of duels 60s)")
    duration: Option[String],
    @arg(doc = "seed of every random choice (default: 1)")
    seed: Option[Long],
    @arg(doc = "number of threads; does not change the result (default: one per core)")
    threads: Option[Int]
):
  /** @param otherwise an episode's duration, if no option sets it */
  def conditions(period: Span, otherwise: Span = ForwardOptions.DuelDuration): Either[String, Conditions] =
    for duration <- duration.fold(Right(otherwise))(Span.parse).left.map("--duration: " + _)
    yield Conditions(
      loop.getOrElse("stream"),
      plant.getOrElse("reduced"),
      period.toMillis,
      duration.toNanos / 1e9,
      altitude.getOrElse(PaperDuel.AltitudeM),
      eye,
      movesInFlight.getOrElse(Moves.InFlight),
      sensors
    )

  def threadCount: Either[String, Int] = ForwardOptions.threadCount(threads)

  /** @param role the role of the policy that is evaluated */
  def opponentOf(role: Role)(using Scenarios): Either[String, PolicyFile] =
    val other = Role.opponentOf(role)
    opponent.fold(Right(PolicyFile.paperOf(other)))(ForwardOptions.policy("--opponent", _, other))

object ForwardOptions:
  private val DuelDuration = Span.ofSeconds(60)

  /** Duration of the scenario's flights, and so of its episodes; mistakes in its settings are reported
    * elsewhere.
    */
  def durationOf(scenario: String, settings: Map[String, String])(using Scenarios): Span =
    stated(scenario, settings).fold(_ => DuelDuration, _.duration)

  private def stated(scenario: String, settings: Map[String, String])(using
      scenarios: Scenarios
  ): Either[String, Scenario] =
    for
      kind <- scenarios.kind(scenario).left.map("--scenario: " + _)
      read <- ScenarioSettings.ofKeys(kind, settings).left.map("--set: " + _)
    yield read

  /** The objective of a scenario's flights, which the user must choose.
    *
    * @param known names of the measures that it may sum
    */
  def objectiveOf(told: Option[String], scenario: String, settings: Map[String, String])(
      known: Scenario => Iterable[String]
  )(using Scenarios): Either[String, String] = told match
    case Some(objective) => Right(objective)
    case None            =>
      stated(scenario, settings).flatMap: read =>
        val (name, names) = (ScenarioText.called(scenario), known(read))
        Left(
          if names.isEmpty then s"--scenario: expected measures to optimise, got none in $name"
          else s"--objective: expected a sum of the measures of $name: ${names.mkString(", ")}"
        )

  given ParserForClass[ForwardOptions] = ParserForClass[ForwardOptions]

  /** Number of threads: the number of cores by default. */
  def threadCount(told: Option[Int]): Either[String, Int] =
    val count = told.getOrElse(Runtime.getRuntime.availableProcessors)
    Expect.within("--threads", count, 1, 1024).map(_ => count)

  /** Refuses options that only apply to duels. */
  def ofDuels(others: (String, Option[?])*)(options: ForwardOptions): Either[String, Unit] =
    val told = (others ++ Seq(
      "--opponent" -> options.opponent,
      "--altitude" -> options.altitude,
      "--eye"      -> options.eye
    ))
      .collect { case (flag, Some(_)) => flag }
    Expect.that(told.isEmpty):
      s"--scenario: expected settings of the scenario, got ${told.mkString(", ")}, which is a duel's"

  /** Reads a policy file, or a family with its defaults. */
  def policy(option: String, text: String, role: Role)(using Scenarios): Either[String, PolicyFile] =
    PolicyFile.chosen(role, text).left.map(mistake => s"$option: $mistake")
