package skein.cli

import java.nio.charset.StandardCharsets.UTF_8
import scala.collection.immutable.ArraySeq
import scala.concurrent.Future
import mainargs.ParserForClass
import skein.flight.NotFlown
import skein.measure.{FlightSummary, SummaryBytes}
import skein.report.{PaperReport, ReportSections, Section}
import skein.scenario.Scenarios
import skein.search.{BlockBytes, BlockExecutor}
import skein.testing.Unhurried

class SpreadQuestionSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = PaperReport.scenarios

  private def options(words: String) =
    ParserForClass[FlightOptions].constructOrThrow(words.split(' ').toSeq)

  private def question(words: String): SpreadQuestion =
    val asked = options(words)
    asked.configuration
      .flatMap(config => asked.settings.flatMap(SpreadQuestion.of(config, _)))
      .fold(fail(_), identity)

  private def ready(words: String) = SpreadQuestion.Ready(options(words).settings.fold(fail(_), identity))

  /** A worker that knows only the question's bytes; it answers the last block first. */
  private def worker(words: String)(change: ArraySeq[Byte] => ArraySeq[Byte] = identity): BlockExecutor =
    val solver =
      QuestionKind.solvers.of(QuestionKind.Spread.of(question(words).bytes)).fold(fail(_), identity)()
    new BlockExecutor:
      def cancel(): Unit                                                           = ()
      def compute(works: Vector[ArraySeq[Byte]], onAnswer: ArraySeq[Byte] => Unit) =
        val answers = works.reverse.map(solver.solve).reverse.map(change)
        answers.foreach(onAnswer)
        Future.successful(Right(Some(answers)))

  private def text(flown: Vector[Either[NotFlown, FlightSummary]]) =
    Section.text(ReportSections.spread(flown.flatMap(_.toOption)))

  private def bytes(flown: Vector[Either[NotFlown, FlightSummary]]) =
    flown.map(_.map(SummaryBytes.write))

  private val duels = "--loop paused --loop predictive --link vpn --duration 12s"

  private lazy val duelsHere =
    val asked = ready(duels)
    SpreadFlights.fly(asked.settings, asked.flights(2))

  for
    (name, words) <- Seq(
      "duels"  -> duels,
      "a team" -> "--scenario surround --loop paused --loop stream --link vpn --duration 8s"
    )
  do
    test(s"$name run by workers have the results of a local run, to the bit"):
      val asked = ready(words)
      val here  = if words == duels then duelsHere else SpreadFlights.fly(asked.settings, asked.flights(2))
      var count = 0
      val there =
        asked.elsewhere(worker(words)(), 2, line => fail(line))(count += 1)(()).fold(fail(_), identity)
      assertEquals((here.count(_.isRight), count), (4, 4))
      assertEquals(text(there), text(here))
      assertEquals(bytes(there), bytes(here))
      for (one, other) <- there.zip(here); (a, b) <- one.toOption.zip(other.toOption) do
        assertEquals(a, b)
        assertEquals(a.distance, b.distance)
        assertEquals(a.result.map(_.measured.map(_.value)), b.result.map(_.measured.map(_.value)))

  test("a flight too large for a message is run in this process and reported; truncated answers are refused"):
    val asked = ready(duels)
    var told  = Vector.empty[String]
    val large = worker(duels)(_ => BlockBytes.of(SpreadQuestion.FlightAnswer.TooLarge))
    val there = asked.elsewhere(large, 1, told :+= _)(())(()).fold(fail(_), identity)
    assertEquals(bytes(there), bytes(Vector(duelsHere(0), duelsHere(2))))
    assertEquals(told.size, 1)
    assert(clue(told.head).startsWith("2 of 2 flights are too large"))
    val cut = asked.elsewhere(worker(duels)(answer => answer.take(answer.length / 2)), 1, _ => ())(())(())
    assert(clue(cut).left.exists(_.startsWith("expected a flight's answer")))

  test("a flight that a worker could not run is reported with its seed and the reason"):
    val asked  = ready(duels)
    val failed = worker(duels)(_ => BlockBytes.of(SpreadQuestion.FlightAnswer.NotFlown("no rotor turned")))
    val there  = asked.elsewhere(failed, 2, line => fail(line))(())(()).fold(fail(_), identity)
    assertEquals(
      there.map(_.left.map(_.message)).last,
      Left("predictive-vpn, seed 2: no rotor turned")
    )

  test("a worker with other flights refuses, and so does the command if workers could not load the policy"):
    val other = String(question(duels).bytes.toArray, UTF_8).replace("vpn", "direct")
    val told  = SpreadQuestion.solvers.of(ArraySeq.unsafeWrapArray(other.getBytes(UTF_8)))
    assert(clue(told).left.exists(_.startsWith("short flights are others here")))
    val asked   = options("--policy unix:pursuer:/nowhere")
    val config  = asked.configuration.fold(fail(_), identity)
    val outside =
      SpreadQuestion.of(config, ready(duels).settings)
    assert(clue(outside).left.exists(_.startsWith("--policy unix:pursuer:/nowhere")))
