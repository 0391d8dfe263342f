package skein.cli

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Path
import java.util.concurrent.atomic.{AtomicBoolean, AtomicInteger}
import java.util.concurrent.{CountDownLatch, TimeUnit}
import scala.collection.immutable.ArraySeq
import scala.concurrent.{Future, Promise}
import skein.optimise.Evaluator
import skein.scenario.Scenarios
import skein.search.{ClusterEvaluator, BlockExecutor, Judge}
import skein.settings.PolicyFile
import skein.testing.{Lengthy, Optimised, TemporaryFolders}
import skein.training.{LearnFile, LearnRun, LearnSetup, LearnState}

class LearnWorkSimulation extends munit.FunSuite, Lengthy, Optimised, TemporaryFolders:
  private given Scenarios = Scenarios.ours

  private val question = LearnCommand
    .question(
      mainargs
        .ParserForClass[LearnOptions]
        .constructOrThrow("--network 4 --fresh 24 --duration 12s --seed 3".split(' ').toSeq)
    )
    .fold(fail(_), identity)
  private val setup  = question.setup.fold(fail(_), identity)
  private val policy = PolicyFile(
    setup.role,
    setup.family,
    Vector.tabulate(setup.family.space.dimension)(number => math.sin(number.toDouble))
  )

  private lazy val worker = workerOf(setup)

  /** A worker that knows only the question's bytes; it answers the last block first. */
  private def workerOf(setup: LearnSetup): BlockExecutor =
    val solver =
      QuestionKind.solvers.of(QuestionKind.Learn.of(LearnWork.question(setup))).fold(fail(_), identity)()
    new BlockExecutor:
      def cancel(): Unit                                                           = ()
      def compute(works: Vector[ArraySeq[Byte]], onAnswer: ArraySeq[Byte] => Unit) =
        Future.successful(Right(Some(works.reverse.map(solver.solve).reverse)))

  test("episodes evaluated by workers equal those of a local run to the bit"):
    for judge <- Seq(Judge.Winner, Judge.Baseline) do
      val elsewhere  = ClusterEvaluator(LearnWork.episodes(worker), judge, atMost = 16, _ => ())
      val candidates = Vector(if judge == Judge.Baseline then setup.baseline.candidate else policy.parameters)
      val here       = setup.judges(threads = 2)(judge).tallies(candidates, 0 until 24)
      assertEquals(elsewhere.tallies(candidates, 0 until 24), here)

  test("flights in virtual time by workers have the results of a local run"):
    val here = LearnCommand.flown(setup, policy, 2).fold(fail(_), identity)
    assertEquals(LearnWork.distances(worker, policy, 2)(()).map(_.flatten), Right(here))
    assertEquals(here.size, 2)

  private lazy val short =
    val words =
      "--steps 2000 --environments 16 --lesson 5s --network 4 " +
        "--episodes 4 --duration 12s --updates-per-step 0.02"
    LearnCommand
      .question(mainargs.ParserForClass[LearnOptions].constructOrThrow(words.split(' ').toSeq))
      .flatMap(_.setup)
      .fold(fail(_), identity)

  test("learning continues while a worker evaluates the policy, with a local run's result to the bit"):
    assert(short.rounds >= 3, short.rounds.toString)
    val here                 = short.judges(1)(Judge.Candidates)
    val round                = CountDownLatch(1)
    val elsewhere: Evaluator = (candidates, episodes) =>
      assert(round.await(60, TimeUnit.SECONDS), "learning waited for its judge")
      here.tallies(candidates, episodes)
    def learned(judge: Evaluator, isElsewhere: Boolean)(onRound: LearnState => Unit) =
      LearnRun(short, judge, None, () => 0, isElsewhere).run(LearnState(), 1, () => false)(onRound)
    val beside = learned(elsewhere, isElsewhere = true)(_ => round.countDown())
    assertEquals(beside, learned(here, isElsewhere = false)(_ => ()))
    assert(beside.exists(_.state.scores.sizeIs >= 3), beside.toString)

  test("stopped learning does not wait for a worker, and is resumed with an uninterrupted run's result"):
    val isStopped                                                  = AtomicBoolean()
    def learned(by: BlockExecutor, folder: Path, from: LearnState) =
      var now     = 0L
      def later() =
        now += 60_000_000_000L
        now
      val judge = ClusterEvaluator(LearnWork.episodes(by), Judge.Candidates, atMost = 16, _ => ())
      LearnRun(short, judge, Some(folder), () => later(), isElsewhere = true)
        .run(from, 1, () => isStopped.get)(_ => ())
        .flatMap(_.unfailing)
        .fold(fail(_), identity)
    val answering = workerOf(short)
    val whole     = learned(answering, temporaryFolder(), LearnState())
    val folder    = temporaryFolder()
    // Does not answer the last evaluation.
    object Silent extends BlockExecutor:
      private val answer = Promise[Either[String, Option[Vector[ArraySeq[Byte]]]]]()
      private val posed  = AtomicInteger()
      def cancel(): Unit = answer.success(Right(None)): Unit
      def compute(works: Vector[ArraySeq[Byte]], onAnswer: ArraySeq[Byte] => Unit) =
        if posed.incrementAndGet() < whole.scores.size then answering.compute(works, onAnswer)
        else
          isStopped.set(true)
          answer.future
    val stopped = learned(Silent, folder, LearnState())
    assertEquals(stopped.rounds, short.rounds - 1)
    assertEquals(LearnFile.read(folder).map(_.state), Right(stopped))
    isStopped.set(false)
    assertEquals(learned(answering, folder, stopped), whole)

  test("a worker whose result differs from the question's probe refuses the question"):
    val other = String(LearnWork.question(setup).toArray, UTF_8).replaceAll("\"seed\":\"?3\"?", "\"seed\":4")
    val told  = LearnWork.solvers.of(ArraySeq.unsafeWrapArray(other.getBytes(UTF_8)))
    assert(clue(told).left.exists(_.startsWith("the baseline comes to")))
