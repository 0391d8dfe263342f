package skein.cli

import skein.policy.*
import skein.scenario.*
import skein.testing.Unhurried
import skein.torture.FaultVerdict
import skein.units.*

class TortureQuestionSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = Scenarios(ScenarioKind(Failing()))

  private val duration = Span.ofSeconds(12)

  private def ready(of: TortureQuestion) = of.ready.fold(fail(_), identity)

  test("flights run in blocks by workers have the results of a local run, including broken rules"):
    val question = TortureQuestion.of(duration, Some("failing"), None)
    var here     = Vector.empty[FaultVerdict]
    ready(question).fly(Iterator(3, 4, 5), threads = 1)(here :+= _)
    val worker    = TortureQuestion.read(question.bytes).fold(fail(_), identity)
    val elsewhere = ready(question).blocks(3, 3, atMost = 2).flatMap: block =>
      ready(question).verdicts(worker.answer(block))
    assertEquals(elsewhere.map(_.faultPlan.seed), Vector(3L, 4L, 5L))
    assertEquals(elsewhere.map(_.violations), here.map(_.violations))
    assert(clue(here.head.violations).nonEmpty)

  test("a worker that does not know the scenario refuses"):
    val question = TortureQuestion.of(duration, Some("unknown"), None)
    assert(clue(TortureQuestion.read(question.bytes)).left.exists(_.startsWith("--scenario: ")))

/** A scenario whose policy throws after some time. */
final case class Failing(afterS: Double = 4) extends Scenario:
  def agents: Vector[Agent] =
    Vector(Agent("Lone", Role("Lone"), MetresPerSecond(6), Vector3(0, 0, -10), Radians(0), GivesUp(afterS)))

final case class GivesUp(afterS: Double) extends Policy:
  type Memory = Unit
  def start: Unit                                             = ()
  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    if seen.elapsed.toSeconds > afterS then throw IllegalStateException("gave up") else (Action.Hover, ())
