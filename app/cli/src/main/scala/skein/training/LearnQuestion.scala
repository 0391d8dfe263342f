package skein.training

import skein.environment.{EnvironmentBatch, EnvironmentSettings}
import skein.forward.{Delays, Engagement}
import skein.lanes.{Engine, TeamBatch, TeamCandidate}
import skein.learn.{Algorithm, LearnerSettings, SideTask}
import skein.optimise.{DuelEvaluator, Objective, TeamEvaluator, TeamObjective, ValueEvaluator, WeightedSum}
import skein.policy.{Fleet, LearnedPolicy, PolicyFamily, Role}
import skein.scenario.{PaperDuel, ScenarioText, Scenarios}
import skein.search.{Baseline, Conditions, Judge}
import skein.settings.{PolicyFile, ScenarioSettings}
import skein.units.Decimals.significant
import skein.units.Expect
import upickle.default.ReadWriter

/** A learning task in the user's words: enough to continue it, or to repeat it.
  *
  * @param conditions of learning and evaluation
  * @param opponent a policy as [[PolicyFile.text]] writes it, of the other role; in the duel
  * @param objective by which the policy is evaluated from time to time; the reward of learning is a small, or
  *   a great, distance
  * @param steps of all environments together
  * @param environments that run side by side
  * @param lessonS duration of a learning episode, s
  * @param startLeastM least initial distance of the evader, m
  * @param turnRateRadPerS greatest turn rate of the policy
  * @param episodes of an evaluation during learning
  * @param fresh episodes of the final evaluation
  */
final case class LearnQuestion(
    algorithm: String,
    role: String,
    objective: String,
    conditions: Conditions,
    link: String,
    opponent: String,
    steps: Long,
    environments: Int,
    lessonS: Double,
    startLeastM: Double,
    startMostM: Double,
    turnRateRadPerS: Double,
    learner: LearnerSettings,
    episodes: Int,
    fresh: Int,
    seed: Long,
    scenario: String = PaperDuel.Name,
    set: Map[String, String] = Map.empty
) derives ReadWriter:
  import LearnQuestion.*

  /** @return Left states what was expected, what was given, and in which option */
  def setup(using scenarios: Scenarios): Either[String, LearnSetup] =
    for
      algorithm <- Algorithm.parse(algorithm).left.map("--algorithm: " + _)
      role      <- PolicyFile.role(role).left.map("--side: " + _)
      game      <- if scenarios.isPapersGame(scenario, set) then duel(role) else team(role)
      _ <- conditions.eye.map(_ => "--eye: expected with search or budget; learners know no eyes").toLeft(())
      flown  <- conditions.resolved
      delays <- conditions.delays(link, game.scenario.agents.size).left.map("--link: " + _)
      _      <- whole("--steps", steps, 1, MostSteps)
      _      <- whole("--environments", environments, 1, MostEnvironments)
      _      <- within("--lesson", lessonS, 1, 3600, " s")
      _      <- within("--turn-rate", turnRateRadPerS, 1e-3, 50, " rad/s")
      _      <- whole("--episodes", episodes, 2, MostEpisodes)
      _      <- whole("--fresh", fresh, 2, MostEpisodes)
      _      <- learner.mistake.map(asOption).toLeft(())
      _      <- Expect.that(algorithm != Algorithm.Ppo || learner.batch <= learner.horizon * environments):
        "--batch: expected at most the " +
          s"${learner.horizon * environments} steps of a lesson of ppo, came ${learner.batch}"
      setup = LearnSetup(this, algorithm, role, game, flown, delays)
      most  = Int.MaxValue * setup.stepsOfRound
      _ <- Expect.that(steps <= most):
        s"--steps: expected at most $most, which are ${Int.MaxValue} lessons in each environment, came $steps"
    yield setup

  private def duel(role: Role)(using Scenarios): Either[String, LearnGame] =
    for
      by    <- Objective.parse(objective, role).left.map("--objective: " + _)
      other <- PolicyFile.parse(Role.opponentOf(role), opponent).left.map("--opponent: " + _)
    yield LearnGame.OfDuel(by, other, PaperDuel(altitudeM = conditions.altitudeM))

  private def team(role: Role)(using scenarios: Scenarios): Either[String, LearnGame] =
    for
      kind   <- scenarios.kind(scenario).left.map("--scenario: " + _)
      stated <- ScenarioSettings.ofKeys(kind, set).left.map("--set: " + _)
      by     <-
        TeamObjective.parse(objective, stated, TeamObjective.naturally(role)).left.map("--objective: " + _)
    yield LearnGame.OfTeam(by, stated)

object LearnQuestion:
  given ReadWriter[LearnerSettings] = ReadWriter.derived

  private val MostSteps        = 1_000_000_000_000L
  private val MostEnvironments = 1 << 16
  private val MostEpisodes     = 1_000_000

  private def within(
      option: String,
      value: Double,
      least: Double,
      most: Double,
      unit: String
  ): Either[String, Unit] =
    Expect.that(value >= least && value <= most):
      s"$option: expected ${least.significant(4)} to " +
        s"${most.significant(4)}$unit, came ${value.significant(4)}$unit"

  private def whole(option: String, value: Long, least: Long, most: Long): Either[String, Unit] =
    Expect.that(value >= least && value <= most)(s"$option: expected $least to $most, came $value")

  /** Renames a mistake's subject to its option: `learning rate: …` becomes `--learning-rate: …`. */
  private def asOption(mistake: String) =
    val (name, why) = mistake.splitAt(mistake.indexOf(':'))
    s"--${name.replace(' ', '-')}$why"

/** A learning task that is resolved and ready to run. */
final case class LearnSetup(
    question: LearnQuestion,
    algorithm: Algorithm,
    role: Role,
    game: LearnGame,
    conditions: Conditions.Resolved,
    delays: Delays
):
  val family: PolicyFamily = PolicyFamily.learned(LearnedPolicy.shape(question.learner.hidden))

  private def isOfTeam = game match
    case _: LearnGame.OfTeam => true
    case _: LearnGame.OfDuel => false

  /** The baseline of every result: the paper's policy of the role, or the result of the scenario's own
    * policies.
    */
  val baseline: Baseline = game match
    case _: LearnGame.OfDuel    => Baseline.of(PolicyFile.paperOf(role))
    case team: LearnGame.OfTeam =>
      Baseline("own", s"${team.scenario.name}'s own", Vector.empty, "its own policies")

  /** Steps of each environment between two points at which everything may be saved. */
  val stepsPerRound: Int = (question.lessonS * 1000 / question.conditions.periodMs).round.toInt.max(1)

  val stepsOfRound: Long = stepsPerRound.toLong * question.environments
  val rounds: Int        = ((question.steps + stepsOfRound - 1) / stepsOfRound).max(1).toInt

  /** Number of rounds from one evaluation of the policy to the next. */
  val roundsPerScore: Int = (rounds / LearnSetup.Scores).max(1)

  /** Evaluators of policies of [[family]], and of the baseline. */
  def judges(threads: Int): Judge => ValueEvaluator = game match
    case duel: LearnGame.OfDuel =>
      val batch                       = conditions.batch(threads)
      def evaluator(of: PolicyFamily) = DuelEvaluator(
        batch,
        conditions.duel.durationS,
        of,
        role,
        duel.against.policy,
        delays,
        duel.objective,
        question.seed,
        shareEpisodes = false
      )
      val (paper, learned) = (evaluator(PolicyFamily.paperOf(role)), evaluator(family))
      judge => if judge == Judge.Baseline then paper else learned
    case team: LearnGame.OfTeam =>
      val batch = TeamBatch(conditions.timing, conditions.vehicle.response, threads)
      def evaluator(of: Vector[Double] => Fleet) =
        TeamEvaluator(
          batch,
          candidate(team, of),
          delays,
          team.objective.terms.map(_._1),
          question.seed,
          shareEpisodes = false
        )
      val own     = evaluator(_ => team.scenario.fleet)
      val learned = evaluator(PolicyFile(role, family, _).flownIn(team.scenario.fleet))
      judge => if judge == Judge.Baseline then own else learned

  private def candidate(team: LearnGame.OfTeam, fleet: Vector[Double] => Fleet)(parameters: Vector[Double]) =
    val durationS = conditions.duel.durationS
    TeamCandidate(
      Engagement.of(fleet(parameters), durationS),
      TeamObjective.judged(team.objective.measures, durationS, conditions.timing.periodS)
    )

  /** What flies while it learns. */
  def engine: Engine = game match
    case _: LearnGame.OfTeam => EnvironmentBatch.engineOf(question.scenario)
    case _                   => EnvironmentBatch.EngineOfGame

  /** @return Left states what was expected and what was given */
  def task(using Scenarios): Either[String, SideTask] =
    SideTask.of(environment, game.opponent, question.environments, question.seed)

  private def environment =
    EnvironmentSettings(
      learners = question.role,
      loop = question.conditions.loop,
      link = question.link,
      periodMs = question.conditions.periodMs,
      plant = question.conditions.plant,
      altitudeM = question.conditions.altitudeM,
      episodeS = question.lessonS,
      startWithinM = (question.startLeastM, question.startMostM),
      turnRateRadPerS = question.turnRateRadPerS,
      evaderRateRadPerS = question.turnRateRadPerS,
      scenario = question.scenario,
      set = question.set,
      objective = if isOfTeam then game.text else ""
    )

  def title: String =
    val where = if isOfTeam then s" of ${ScenarioText.called(question.scenario)}" else ""
    s"${question.algorithm}, ${question.role}$where, ${question.conditions.loop} over ${question.link}"

  /** The objective with its unit, for the axis of a picture. */
  def measure: String = WeightedSum.withUnit(game.formula, game.unit)

  /** Whether learning used the scenario's own policies for all others, as its flights do. */
  def isFlownAsTaught: Boolean = game.opponent.forall(other => other == PolicyFile.paperOf(other.role))

  def policy(weights: Vector[Double]): PolicyFile =
    PolicyFile(role, family, weights ++ bounds)

  /** The greatest turn rate, as a [[LearnedPolicy]]'s last parameters. */
  def bounds: Vector[Double] = Vector(question.turnRateRadPerS, 0.0)

object LearnSetup:
  /** Approximate number of evaluations in all. */
  private val Scores = 60
