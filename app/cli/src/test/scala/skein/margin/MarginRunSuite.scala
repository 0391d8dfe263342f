package skein.margin

import skein.scenario.{PaperDuel, Track, Tracks}
import skein.units.*

class MarginRunSuite extends munit.FunSuite:
  import MarginRun.{Ended, NoResult}

  /** Two vehicles at rest, 30 m apart, for 20 s. */
  private val tracks =
    def at(north: Double) = Vector(0, 20).map(second =>
      (Instant.Epoch + Span.ofSeconds(second), Vector3(north, 0, -20), Vector3.Zero)
    )
    Tracks.of(Vector(Track.of("Evader", "Evader", at(30)), Track.of("Pursuer", "Pursuer", at(0))))

  private val flown = MarginJudge.read(None, Some(PaperDuel()), 2).toOption.get

  private val fine = Ended(
    exit = None,
    lasted = Span.ofSeconds(20),
    connections = 1,
    commands = 100,
    silentFor = Span.ofMillis(50),
    lastLine = None,
    lastError = None,
    contacts = 2,
    tracks = tracks,
    starved = None
  )

  private def why(by: MarginJudge, ended: Ended) = MarginRun.judged(by, ended).left.toOption.map(_.why)

  test("a program that still runs at the end is scored by its vehicles' positions"):
    assertEquals(MarginRun.judged(flown, fine), Right(30.0))
    assertEquals(MarginRun.judged(flown, fine.copy(exit = Some(0))), Right(30.0))
    assertEquals(MarginRun.judged(MarginJudge.Contacts, fine), Right(2.0))

  test("a program that dies has no result, and the reason includes its last error line"):
    val died = fine.copy(exit = Some(1), lastError = Some("ValueError: no"))
    assertEquals(why(flown, died), Some("it ended with exit status 1 after 20.0 s: ValueError: no"))

  test("a program that never connects, or never commands, has no result"):
    assert(why(flown, fine.copy(connections = 0)).exists(_.startsWith("it never connected")))
    assert(why(MarginJudge.Printed, fine.copy(connections = 0)).exists(_.startsWith("it never connected")))
    assertEquals(why(flown, fine.copy(commands = 0)), Some("it connected, and commanded nothing"))

  test("a program that sends nothing for half of its time has hung; one that waits for a move has not"):
    assert(why(flown, fine.copy(silentFor = Span.ofSeconds(11))).exists(_.startsWith("it hung")))
    assertEquals(why(flown, fine.copy(silentFor = Span.ofSeconds(9))), None)

  test("silence lasts from the last message to the last look, however long the program takes to end"):
    def at(seconds: Double) = Instant.Epoch + Span.ofSeconds(seconds)
    val course              = MarginCourse(at(3)).looked(at(4), Span.Zero).looked(at(5), Span.ofSeconds(1))
      .looked(at(9), Span.ofSeconds(1))
    assertEquals((course.lasted, course.silentFor), (Span.ofSeconds(6), Span.ofSeconds(4)))

  test("a flight too short for the measure has no result"):
    val short = fine.copy(tracks = None)
    assertEquals(why(flown, short), Some("it has no value of 'last 10 s' after 20.0 s"))
    assertEquals(why(MarginJudge.Contacts, short), Some("it has no value of 'contacts' after 20.0 s"))

  test("a busy machine spoils a run, but a program that dies meanwhile counts as failed"):
    val starved = fine.copy(starved = Some("the machine was too busy"))
    assertEquals(MarginRun.judged(flown, starved), Left(NoResult.OfMachine("the machine was too busy")))
    assert(why(flown, starved.copy(exit = Some(2))).exists(_.contains("exit status 2")))

  test("a printed number must be the last line of a program that has ended"):
    def printed(line: String) = fine.copy(exit = Some(0), lastLine = Some(line), commands = 0)
    assertEquals(MarginRun.judged(MarginJudge.Printed, printed("4.25")), Right(4.25))
    assertEquals(
      why(MarginJudge.Printed, printed("done")),
      Some("expected a number as the last line that it prints, got 'done'")
    )
    assert(why(MarginJudge.Printed, printed("NaN")).exists(_.contains("got 'NaN'")))
    assert(why(MarginJudge.Printed, fine.copy(lastLine = Some("4"))).exists(_.contains("still ran")))

  test("a judge is one of the scenario's measures, or built in"):
    def read(text: String, vehicles: Int = 2) = MarginJudge.read(Some(text), Some(PaperDuel()), vehicles)
    assertEquals(read("last-10-s").map(_.name), Right("last 10 s"))
    assertEquals(read("separation").map(MarginRun.judged(_, fine)), Right(Right(30.0)))
    assertEquals(read("distance").map(MarginRun.judged(_, fine)), Right(Right(30.0)))
    assertEquals(read("distance:30,0,-16").map(MarginRun.judged(_, fine)), Right(Right(4.0)))
    assertEquals(read("distance:0,0").isLeft, true)
    assert(read("speed").left.exists(_.contains("expected one of last-10-s, sd, closest, at, printed")))
    assert(read("separation", vehicles = 1).left.exists(_.contains("two vehicles or more")))
    assert(MarginJudge.read(None, None, 1).left.exists(_.contains("got nothing")))

  test("delays are read as evenly spaced steps"):
    assertEquals(
      MarginDelays.read("50ms..0.2s/4").map(_.map(_.name)),
      Right(Vector("constant:50ms", "constant:100ms", "constant:150ms", "constant:200ms"))
    )
    assertEquals(MarginDelays.read("50ms..50ms/1").map(_.size), Right(1))
    for wrong <- Seq("50ms", "200ms..50ms/4", "50ms..200ms/0", "50..200/4", "50ms..200ms/x") do
      assertEquals(
        MarginDelays.read(wrong),
        Left(s"expected FROM..TO/COUNT, for example 50ms..200ms/4, got '$wrong'")
      )
