package skein.budget

import scala.collection.immutable.ArraySeq
import scala.concurrent.Future
import skein.policy.{PolicyFamily, Role}
import skein.scenario.Scenarios
import skein.search.{Conditions, BlockExecutor}
import skein.settings.PolicyFile
import skein.signal.LatencyDistribution
import skein.testing.Optimised
import skein.units.Span

class ClusterSubjectSimulation extends munit.FunSuite, Optimised:
  private given Scenarios = Scenarios.ours

  private val questions = Vector[BudgetQuestion](
    BudgetQuestion.OfDuel(
      "pursuer",
      PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.leadPursuit).text,
      PolicyFile.paperOf(Role.Evader).text,
      "last10s",
      Conditions("stream", "reduced", 100, 12),
      seed = 3
    ),
    BudgetQuestion.OfScenario(
      "surround",
      Map("vehicles" -> "4"),
      None,
      Conditions("stream", "drag", 100, 12),
      plantIsTold = false,
      seed = 3
    )
  )

  private lazy val here = questions.map(_.subject(threads = 2).fold(fail(_), identity))

  private lazy val question = ClusterSubject.bytes(questions, here).fold(fail(_), identity)

  private val links = Vector(20, 80, 140).map(ms => LatencyDistribution.Uniform(Span.Zero, Span.ofMillis(ms)))

  private def tallies(of: BudgetSubject) = of.tallies(BudgetCells(links, 4))

  test("cells computed by workers, one by one and in any order, equal those of a local run to the bit"):
    val solver    = ClusterSubject.solvers.of(question).fold(fail(_), identity)()
    val elsewhere = new BlockExecutor:
      def cancel(): Unit                                                           = ()
      def compute(works: Vector[ArraySeq[Byte]], onAnswer: ArraySeq[Byte] => Unit) =
        assertEquals(works.size, links.size)
        Future.successful(Right(Some(works.reverse.map(solver.solve).reverse)))
    for (one, number) <- here.zipWithIndex do
      assertEquals(
        tallies(ClusterSubject(one, number, elsewhere, () => 1, Some(4))),
        tallies(one),
        one.task.label
      )

  test("a worker whose result differs from the question's probe refuses the question"):
    val other = String(question.toArray, "UTF-8").replaceAll("\"seed\":\"?3\"?", "\"seed\":4")
    val told  = ClusterSubject.solvers.of(ArraySeq.unsafeWrapArray(other.getBytes("UTF-8")))
    assert(clue(told).left.exists(_.startsWith("one episode does not come to the same")))
