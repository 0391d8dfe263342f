package skein.training

import skein.environment.EnvironmentSettings
import skein.forward.Delays
import skein.lanes.DuelBatch
import skein.learn.{Algorithm, DuelTask, LearnerSettings}
import skein.optimise.{DuelEvaluator, Objective, ValueEvaluator, WeightedSum}
import skein.policy.{LearnedPolicy, PolicyFamily, Role}
import skein.search.Conditions
import skein.scenario.Scenarios
import skein.settings.PolicyFile
import skein.units.Decimals.significant
import upickle.default.ReadWriter

/** What is to be learned, in the words of the user; enough to go on with it, or to learn it again.
  *
  * @param conditions
  *   under which is learned and judged
  * @param opponent
  *   a policy as [[PolicyFile.text]] writes it, of the other role
  * @param objective
  *   by which the policy is judged now and then; what is learned is a small, or a great, distance
  * @param steps
  *   of all environments together
  * @param environments
  *   side by side
  * @param lessonS
  *   how long an episode of learning lasts
  * @param startLeastM
  *   it begins with the evader so far away
  * @param turnRateRadPerS
  *   the most that a pursuer turns
  * @param episodes
  *   on which the policy is judged now and then
  * @param fresh
  *   on which it is judged at the end
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
    seed: Long
) derives ReadWriter:
  import LearnQuestion.*

  /** @return or what was expected, what came, and in which option */
  def setup(using Scenarios): Either[String, LearnSetup] =
    for
      algorithm <- Algorithm.parse(algorithm).left.map("--algorithm: " + _)
      role      <- PolicyFile.role(role).left.map("--side: " + _)
      objective <- Objective.parse(objective, role).left.map("--objective: " + _)
      _ <- conditions.eye.map(_ => "--eye: expected with search or budget; learners know no eyes").toLeft(())
      flown    <- conditions.resolved
      delays   <- Conditions.delays(link).left.map("--link: " + _)
      opponent <- PolicyFile
        .parse(Role.opponentOf(role), opponent)
        .left
        .map("--opponent: " + _)
      _ <- within("--steps", steps.toDouble, 1, MostSteps)
      _ <- within("--environments", environments, 1, MostEnvironments)
      _ <- within("--lesson", lessonS, 1, 3600, " s")
      _ <- within("--turn-rate", turnRateRadPerS, 1e-3, 10, " rad/s")
      _ <- within("--episodes", episodes, 2, MostEpisodes)
      _ <- within("--fresh", fresh, 2, MostEpisodes)
      _ <- learner.mistake.map(asOption).toLeft(())
      _ <- Either.cond(
        algorithm != Algorithm.Ppo || learner.batch <= learner.horizon * environments,
        (),
        s"--batch: expected at most the ${learner.horizon * environments} steps of a lesson of ppo, came ${learner.batch}"
      )
    yield LearnSetup(this, algorithm, role, objective, flown, delays, opponent)

object LearnQuestion:
  given ReadWriter[LearnerSettings] = ReadWriter.derived

  private val MostSteps        = 1e12
  private val MostEnvironments = 1 << 16
  private val MostEpisodes     = 1_000_000

  private def within(
      option: String,
      value: Double,
      least: Double,
      most: Double,
      unit: String = ""
  ): Either[String, Unit] =
    Either.cond(
      value >= least && value <= most,
      (),
      s"$option: expected ${least.significant(4)} to ${most.significant(4)}$unit, came ${value.significant(4)}$unit"
    )

  /** `learning rate: …` as `--learning-rate: …`. */
  private def asOption(mistake: String) =
    val (name, why) = mistake.splitAt(mistake.indexOf(':'))
    s"--${name.replace(' ', '-')}$why"

/** Ready to learn. */
final case class LearnSetup(
    question: LearnQuestion,
    algorithm: Algorithm,
    role: Role,
    objective: Objective,
    conditions: Conditions.Resolved,
    delays: Delays,
    opponent: PolicyFile
):
  val family: PolicyFamily = PolicyFamily.learned(LearnedPolicy.shape(question.learner.hidden))

  /** The paper's policy of the role, which every result is held against. */
  val paper: PolicyFile = PolicyFile.paperOf(role)

  /** Steps of one environment between two times at which everything may be saved. */
  val stepsPerRound: Int = (question.lessonS * 1000 / question.conditions.periodMs).round.toInt.max(1)

  val stepsOfRound: Long = stepsPerRound.toLong * question.environments
  val rounds: Int        = ((question.steps + stepsOfRound - 1) / stepsOfRound).max(1).toInt

  /** The policy is judged after so many rounds each. */
  val roundsPerScore: Int = (rounds / LearnSetup.Scores).max(1)

  def batch(threads: Int): DuelBatch = conditions.batch(threads)

  def evaluator(batch: DuelBatch, of: PolicyFamily = family): ValueEvaluator = DuelEvaluator(
    batch,
    conditions.duel.durationS,
    of,
    role,
    opponent.policy,
    delays,
    objective,
    question.seed,
    shareEpisodes = false
  )

  /** @return or what was expected and came */
  def task: Either[String, DuelTask] =
    val settings = EnvironmentSettings(
      learners = question.role,
      loop = question.conditions.loop,
      link = question.link,
      periodMs = question.conditions.periodMs,
      plant = question.conditions.plant,
      altitudeM = question.conditions.altitudeM,
      episodeS = question.lessonS,
      startWithinM = (question.startLeastM, question.startMostM),
      turnRateRadPerS = question.turnRateRadPerS
    )
    DuelTask.of(settings, Some(opponent), question.environments, question.seed)

  def title: String =
    s"${question.algorithm}, ${question.role}, ${question.conditions.loop} over ${question.link}"

  /** For an axis of a picture. */
  def measure: String = WeightedSum.withUnit(objective.formula, objective.unit)

  def isAgainstPaper: Boolean = opponent == PolicyFile.paperOf(opponent.role)

  /** What an actor's weights make. */
  def policy(weights: Vector[Double]): PolicyFile =
    PolicyFile(role, family, weights ++ LearnedPolicy.mostTurn(role, question.turnRateRadPerS))

object LearnSetup:
  /** In all, about. */
  private val Scores = 60
