package skein.learn

import skein.environment.EnvironmentSettings
import skein.policy.*
import skein.scenario.{PaperDuel, Scenario, ScenarioKind, Scenarios}
import skein.testing.{Optimised, Unhurried}

class ClimbingSimulation extends munit.FunSuite, Optimised, Unhurried:
  import ClimbingSimulation.*

  private given Scenarios = Scenarios(Scenarios.ours.kinds :+ ScenarioKind(Above()))

  private val settings = EnvironmentSettings(
    scenario = "above",
    link = "direct",
    startWithinM = (0, 5),
    episodeS = 12,
    turnRateRadPerS = 3,
    climbMps = 4
  )

  test("a pursuer that climbs learns to be nearer to a higher evader than any that keeps its altitude"):
    val task    = SideTask.of(settings, None, 16, 1).fold(fail(_), identity)
    val learner = Algorithm.Sac.learner(
      task.observations,
      task.actions,
      task.count,
      LearnerSettings(
        Vector(16, 16),
        discount = 0.97,
        batch = 128,
        updatesPerStep = 0.25,
        randomSteps = 1600
      ),
      seed = 2,
      BatchThreads(1)
    )
    SideTask.times.foreach(learner.actor.ignore)
    val before   = meanM(task, learner.actor)
    val training = Training(task, learner, Steps)
    for round <- 0 until 32 do assert(training.round(round).isRight)
    val after = meanM(task, learner.actor)
    task.close()
    assert(before > 2 * HigherM, s"$before m before it learned")
    assert(after < 0.9 * HigherM, s"$after m after it learned")

object ClimbingSimulation:
  private val Steps   = 100
  private val HigherM = 10.0

  /** The mean distance in 10 s of equal episodes, by the means of an actor, m. */
  private def meanM(task: SideTask, actor: Network): Double =
    val pass = Pass(actor.widths, task.count)
    task.begin(1000, actor)
    val sums =
      for _ <- 0 until Steps yield
        System.arraycopy(task.seen, 0, pass.input, 0, task.seen.length)
        pass.forward(actor, 0, task.count)
        task.step(Array.tabulate(task.count * task.actions): at =>
          math.tanh(pass.output(at / task.actions * actor.widths.last + at % task.actions)).toFloat)
        task.rewards.sum
    -sums.sum / (Steps * task.count * SideTask.RewardPerM)

  /** The evader flies straight on, higher than the pursuer starts. */
  final case class Above() extends Scenario:
    def agents: Vector[Agent] = PaperDuel().agents.map: agent =>
      val start = agent.startPositionNed
      if agent.role != Role.Evader then agent
      else agent.copy(policy = KeepHeading, startPositionNed = start.copy(z = start.z - HigherM))
