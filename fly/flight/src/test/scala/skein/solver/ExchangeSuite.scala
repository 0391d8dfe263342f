package skein.solver

import skein.loop.Chosen
import skein.policy.Action
import skein.solver.Exchange.Verdict
import skein.units.*

class ExchangeSuite extends munit.FunSuite:
  private def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)
  private val within         = Span.ofMillis(100)
  private val choice         = Right(Choice(at(0), false, Vector(Chosen(Action.Hover))))

  private def asking(times: Double*) =
    times.foldLeft(Exchange.of(2))((exchange, ms) => exchange.asked(0, at(ms), at(ms) + within)._1)

  private def answer(
      number: Long,
      solver: Long = 1,
      overtaken: Long = 0,
      vehicle: Int = 0,
      takenMs: Double = 0
  ) =
    Answer(7, vehicle, number, solver, at(takenMs), at(takenMs + 1), overtaken, 0, choice)

  test("only the first answer to the newest request, before its deadline, counts"):
    val (heard, verdict) = asking(0).heard(answer(0), at(30))
    assertEquals(verdict, Verdict.Counts(at(0)))
    assertEquals(heard.heard(answer(0), at(31))._2, Verdict.Repeated)
    assertEquals(asking(0).heard(answer(0), at(100))._2, Verdict.Late(Span.ofMillis(100)))
    assertEquals(heard.heard(answer(1), at(31))._2, Verdict.Foreign)
    assertEquals(heard.heard(answer(0, vehicle = 1), at(31))._2, Verdict.Foreign)
    for vehicle <- Seq(999, -1) do
      assertEquals(heard.heard(answer(0, vehicle = vehicle), at(31))._2, Verdict.Foreign)

  test("a delayed answer is not used after a newer request"):
    val exchange      = asking(0, 50)
    val (next, first) = exchange.heard(answer(1), at(60))
    assertEquals(first, Verdict.Counts(at(50)))
    val (last, second) = next.heard(answer(0), at(61))
    assertEquals(second, Verdict.Late(Span.ofMillis(61)))
    assertEquals((last.counts.asked, last.counts.used, last.counts.late), (2L, 1L, 1L))

  test("the number of remembered requests is limited"):
    val exchange = asking((0 to 1000).map(_.toDouble)*)
    assert(exchange.vehicles(0).open.size <= Exchange.MostOpen)
    assertEquals(exchange.heard(answer(3), at(1001))._2, Verdict.Repeated)

  test("the solver's clock is known from requests and answers, and anew after the solver's restart"):
    val (one, _) = asking(0).heard(answer(0, takenMs = 1005), at(11))
    assertEquals(one.solverClock, Some((solver = 1L, offset = Span.ofMillis(-1000))))
    val (two, _) = one.asked(0, at(100), at(200))._1.heard(answer(1, solver = 2, takenMs = 5), at(111))
    assertEquals(two.solverClock, Some((solver = 2L, offset = Span.ofMillis(100))))

  test("the expected delay is the recent mean of answers that counted"):
    assertEquals(Exchange.of(1).delay, Span.Zero)
    val (one, _) = asking(0).heard(answer(0), at(10))
    val (two, _) = one.asked(0, at(100), at(200))._1.heard(answer(1), at(130))
    assertEquals(two.delay, Span.ofMillis(20))
    val (late, _) = two.asked(0, at(300), at(400))._1.heard(answer(2), at(900))
    assertEquals(late.delay, Span.ofMillis(20))

  test("time meant for searching is not part of the delay"):
    val (first, _)  = asking().asked(0, at(0), at(0) + within, searching = Span.ofMillis(60))
    val (one, _)    = first.heard(answer(0), at(68))
    val (second, _) = one.asked(1, at(100), at(100) + within)
    val (two, _)    = second.heard(answer(0, vehicle = 1), at(110))
    assertEquals(two.delay, Span.ofMillis(9))

  test("the solver's counts are reported once"):
    val (one, first)  = asking(0).heard(answer(0, overtaken = 3), at(10))._1.news(answer(0, overtaken = 3))
    val (two, second) = one.news(answer(0, overtaken = 3))
    val (_, older)    = two.news(answer(0, overtaken = 2))
    assertEquals((first.overtaken, second.overtaken, older.overtaken), (3L, 0L, 0L))
    assertEquals(two.counts.overtaken, 3L)
