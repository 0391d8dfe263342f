package skein.training

import skein.environment.{EnvironmentBatch, EnvironmentSettings}
import skein.forward.{Delays, Engagement}
import skein.lanes.{Engine, TeamCandidate}
import skein.learn.{Algorithm, LearnerSettings, SideTask}
import skein.optimise.{Objective, RunningStats, TeamEvaluator, ValueEvaluator}
import skein.pickle.Fields
import skein.policy.{LearnedPolicy, LearnerSpace, PolicyFamily, Role}
import skein.scenario.{PaperDuel, ScenarioText, Scenarios}
import skein.search.{Baseline, Conditions, Judge}
import skein.settings.{PolicyFile, ScenarioSettings}
import skein.units.Decimals.significant
import skein.units.Expect

/** A learning task in the user's words: enough to continue it, or to repeat it.
  *
  * @param conditions the conditions of learning and evaluation
  * @param opponent a policy as [[PolicyFile.text]] writes it, of the other role; in the duel
  * @param objective the objective by which the policy is evaluated from time to time; the reward of learning
  *   is a small distance, or a great one
  * @param steps total number of steps of all environments
  * @param environments number of environments that run concurrently
  * @param lessonS duration of a learning episode, s
  * @param startLeastM minimum initial distance of the evader, m
  * @param turnRateRadPerS maximum turn rate of the policy
  * @param climbMps maximum vertical speed of the policy; 0: it keeps its altitude
  * @param episodes number of episodes of an evaluation during learning
  * @param fresh number of episodes of the final evaluation
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
    set: Map[String, String] = Map.empty,
    climbMps: Double = 0
) derives Fields:
  import LearnQuestion.*

  /** @return Left says what was expected, what was given, and in which option */
  def setup(using scenarios: Scenarios): Either[String, LearnSetup] =
    for
      algorithm <- Algorithm.parse(algorithm).left.map("--algorithm: " + _)
      role      <- PolicyFile.role(role).left.map("--side: " + _)
      game      <- if scenarios.isPapersGame(scenario, set) then duel(role) else team(role)
      _ <- conditions.eye.map(_ => "--eye: expected with search or budget; learners know no eyes").toLeft(())
      flown  <- conditions.resolved
      delays <- flown.delays(link, game.scenario.agents.size).left.map("--link: " + _)
      _      <- Expect.within("--steps", steps, 1, MostSteps)
      _      <- Expect.within("--environments", environments, 1, MostEnvironments)
      _      <- within("--lesson", lessonS, 1, 3600, " s")
      _      <- within("--turn-rate", turnRateRadPerS, 1e-3, 50, " rad/s")
      _      <- within("--climb", climbMps, 0, EnvironmentSettings.MostClimbMps, " m/s")
      _      <- Expect.within("--episodes", episodes, 2, MostEpisodes)
      _      <- Expect.within("--fresh", fresh, 2, MostEpisodes)
      _      <- learner.mistake.map(asOption).toLeft(())
      _      <- Expect.that(algorithm != Algorithm.Ppo || learner.batch <= learner.horizon * environments):
        "--batch: expected at most the " +
          s"${learner.horizon * environments} steps of a lesson of ppo, got ${learner.batch}"
      setup = LearnSetup(this, algorithm, role, game, flown, delays)
      most  = Int.MaxValue * setup.stepsOfRound
      _ <- Expect.that(steps <= most):
        s"--steps: expected at most $most, which are ${Int.MaxValue} lessons in each environment, got $steps"
    yield setup

  private def duel(role: Role)(using Scenarios): Either[String, LearnGame] =
    for
      by    <- Objective.ofRole(objective, role).left.map("--objective: " + _)
      other <- PolicyFile.parse(Role.opponentOf(role), opponent).left.map("--opponent: " + _)
    yield LearnGame(by, PaperDuel(altitudeM = conditions.altitudeM), Some(other))

  private def team(role: Role)(using scenarios: Scenarios): Either[String, LearnGame] =
    for
      kind   <- scenarios.kind(scenario).left.map("--scenario: " + _)
      stated <- ScenarioSettings.ofKeys(kind, set).left.map("--set: " + _)
      by     <-
        Objective.ofQuantities(objective, stated, Objective.naturally(role)).left.map("--objective: " + _)
    yield LearnGame(by, stated)

object LearnQuestion:
  given Fields[LearnerSettings] = Fields.derived

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
        s"${most.significant(4)}$unit, got ${value.significant(4)}$unit"

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
  val space: LearnerSpace  = LearnerSpace(question.climbMps > 0)
  val family: PolicyFamily = PolicyFamily.learned(LearnedPolicy.shape(question.learner.hidden, space))

  /** Whether it learned for an objective of a scenario, in place of the distance in a duel. */
  def isOfTeam: Boolean = game.opponent.isEmpty

  /** The baseline of every result: the paper's policy of the role, or the result of the scenario's own
    * policies.
    */
  val baseline: Baseline =
    if isOfTeam then Baseline("own", s"${game.scenario.name}'s own", Vector.empty, "its own policies")
    else Baseline.of(PolicyFile.paperOf(role))

  /** Steps of each environment between two points at which everything may be saved. */
  val stepsPerRound: Int = (question.lessonS * 1000 / question.conditions.periodMs).round.toInt.max(1)

  val stepsOfRound: Long = stepsPerRound.toLong * question.environments
  val rounds: Int        = ((question.steps + stepsOfRound - 1) / stepsOfRound).max(1).toInt

  /** Number of rounds from one evaluation of the policy to the next. */
  val roundsPerScore: Int = (rounds / LearnSetup.Scores).max(1)

  private def flown: Engagement = game.opponent match
    case Some(other) => conditions.game.flownBy(other.role, other.policy)
    case None        =>
      Engagement.ofScenario(game.scenario, conditions.game.durationS)

  /** Evaluators of policies of [[family]], and of the baseline. */
  def judges(threads: Int): Judge => ValueEvaluator =
    val batch  = conditions.batch(threads)
    val team   = flown
    val judged = game.objective.judged(team.durationS, conditions.timing.periodS)
    def evaluator(of: Vector[Double] => Engagement) = TeamEvaluator(
      batch,
      parameters => TeamCandidate(of(parameters), judged),
      delays,
      game.objective,
      question.seed,
      shareEpisodes = false
    )
    val (own, learned) = (evaluator(_ => team), evaluator(from => team.flownBy(role, family.policy(from))))
    judge => if judge == Judge.Baseline then own else learned

  /** The baseline's result on the first episodes, by this process. */
  lazy val probe: Vector[RunningStats] =
    judges(threads = 1)(Judge.Baseline).tallies(Vector(baseline.candidate), LearnSetup.Probes)

  /** The engine of the episodes while it learns; Left says what was expected and what was given. */
  def engine(using Scenarios): Either[String, Engine] =
    EnvironmentBatch.engine(environment, game.opponent, Some(family.defaultPolicy))

  /** @return Left says what was expected and what was given */
  def task(using Scenarios): Either[String, SideTask] =
    SideTask.of(environment, game.opponent, question.environments, question.seed)

  private[training] def environment: EnvironmentSettings =
    EnvironmentSettings(
      learners = question.role,
      loop = question.conditions.loop,
      link = question.link,
      periodMs = question.conditions.periodMs,
      movesInFlight = question.conditions.movesInFlight,
      plant = question.conditions.plant,
      sensors = question.conditions.sensors.getOrElse(""),
      altitudeM = if isOfTeam then 0 else question.conditions.altitudeM,
      episodeS = question.lessonS,
      startWithinM = (question.startLeastM, question.startMostM),
      turnRateRadPerS = question.turnRateRadPerS,
      evaderRateRadPerS = question.turnRateRadPerS,
      climbMps = question.climbMps,
      scenario = question.scenario,
      set = question.set,
      objective = if isOfTeam then game.text else ""
    )

  def title: String =
    val where = if isOfTeam then s" of ${ScenarioText.called(question.scenario)}" else ""
    s"${question.algorithm}, ${question.role}$where, ${question.conditions.loop} over ${question.link}"

  /** The objective with its unit, for the axis of a picture. */
  def measure: String = game.objective.title

  /** Whether the scenario's own policies steered all other vehicles during learning, as they do in flights.
    */
  def isFlownAsTaught: Boolean = game.opponent.forall(other => other == PolicyFile.paperOf(other.role))

  def policy(weights: Vector[Double]): PolicyFile =
    PolicyFile(role, family, weights ++ bounds)

  /** The maximum turn rate and vertical speed, as the last parameters of [[family]]. */
  def bounds: Vector[Double] =
    Vector(question.turnRateRadPerS, 0.0) ++ Option.when(space.climbs)(question.climbMps)

object LearnSetup:
  private val Probes = 0 until 4

  /** Approximate number of evaluations in all. */
  private val Scores = 60
