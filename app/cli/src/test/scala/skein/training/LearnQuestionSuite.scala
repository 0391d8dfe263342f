package skein.training

import skein.learn.LearnerSettings
import skein.scenario.Scenarios
import skein.search.Conditions

class LearnQuestionSuite extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  test("it learns under all conditions by which it is judged"):
    val conditions =
      Conditions("stream", "reduced", 200, 12).copy(movesInFlight = 6, sensors = Some("position=0.1"))
    val question = LearnQuestion(
      "ppo",
      "pursuer",
      "last10s",
      conditions,
      "constant:400ms",
      "paper-evader turningRadiusM=8.0",
      steps = 1,
      environments = 1,
      lessonS = 5,
      startLeastM = 3,
      startMostM = 30,
      turnRateRadPerS = 3,
      LearnerSettings(hidden = Vector(1), batch = 1),
      episodes = 2,
      fresh = 2,
      seed = 1
    )
    val learned = question.setup.fold(fail(_), identity).environment
    assertEquals(
      (learned.loop, learned.link, learned.periodMs, learned.plant, learned.movesInFlight, learned.sensors),
      ("stream", "constant:400ms", 200.0, "reduced", 6, "position=0.1")
    )
