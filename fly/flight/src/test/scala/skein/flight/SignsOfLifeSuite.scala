package skein.flight

import skein.flight.SignsOfLife.Sign
import skein.forward.Asking
import skein.units.*

class SignsOfLifeSuite extends munit.FunSuite:
  private val within = Span.ofMillis(700)

  private def at(millis: Double) = Instant.Epoch + Span.ofMillis(millis)

  test("silence is reported once, when an answer is overdue, and its end once, at the next answer"):
    val looks = Vector[(heardAt: Double, now: Double, sign: Option[Sign])](
      (heardAt = 0.0, now = 700.0, sign = None),
      (heardAt = 0.0, now = 701.0, sign = Some(Sign.Silent(Span.ofMillis(701)))),
      (heardAt = 0.0, now = 5000.0, sign = None),
      (heardAt = 5100.0, now = 5150.0, sign = Some(Sign.Back(Span.ofMillis(5100)))),
      (heardAt = 5100.0, now = 5800.0, sign = None),
      (heardAt = 5100.0, now = 5801.0, sign = Some(Sign.Silent(Span.ofMillis(701))))
    )
    val _ = looks.foldLeft(SignsOfLife()): (life, look) =>
      val (next, sign) = life.look(at(look.heardAt), at(look.now), within)
      assertEquals(sign, look.sign, s"at ${look.now} ms")
      next

  test("if a policy keeps the loop from sending requests, the report of the silence says so"):
    def told(since: Double) =
      SimulatorWatchdog.silence("localhost:1", "1.0 s", Some(("Pursuer", at(since))), at(2000))
    assertEquals(told(1900), "no answer from the simulator at localhost:1 for 1.0 s")
    assert(
      clue(told(500)).endsWith("while Pursuer's policy has not decided for 1.5 s; --deadline limits that")
    )

  test("if answers come after their time-out, the report of the silence says so"):
    assertEquals(
      SimulatorWatchdog.silence(
        "localhost:1",
        "1.0 s",
        None,
        at(2000),
        Some("getState answered after 520 ms")
      ),
      "no answer from the simulator at localhost:1 for 1.0 s within the time-out of 500 ms: getState answered after 520 ms"
    )

  test("a simulator that answers within a flight's period is never silent, however long the period is"):
    assert(SimulatorWatchdog.within(Span.ofMillis(100), Asking.Timeout) < Span.ofMillis(850))
    for seconds <- Seq(0.1, 1.0, 10.0) do
      val period = Span.ofSeconds(seconds)
      val within = SimulatorWatchdog.within(period, Asking.Timeout)
      assert(within > period + Asking.Timeout)
