package skein.flight

import skein.policy.Action
import skein.record.{DecisionRow, LaterDecision, MemoryRecorder}
import skein.report.SyntheticFlight
import skein.units.*

class FlightMonitorSuite extends munit.FunSuite:

  test("progress shows the distance of two vehicles, and only the age for a team"):
    val flown   = SyntheticFlight("stream", "none", seed = 1, seconds = 12)
    val monitor = FlightMonitor(MemoryRecorder(flown.heading))
    val last    = flown.decisions.last
    def text    = FlightProgress("one", Span.ofSeconds(12), monitor.lastSeen(last.decidedAt)).text
    assertEquals(text, "")
    def decided(row: DecisionRow, seesOthers: Boolean) =
      monitor.offer(LaterDecision(
        row.vehicle,
        row.decidedAt,
        row.action.getOrElse(Action.Hover),
        seesOthers,
        Vector.empty,
        row
      ))
    flown.readings.foreach(monitor.offer)
    flown.decisions.foreach(decided(_, seesOthers = false))
    assert(clue(text).matches(" *[0-9.]+ m apart, +[0-9]+ ms old"))
    decided(last, seesOthers = true)
    assert(clue(text).matches(" *[0-9]+ ms old"))

  test("progress shows that a flight has ended while others run, without a growing age"):
    val seen = Some(LastSeen(Some(Metres(8.4)), Span.ofSeconds(7)))
    assertEquals(FlightProgress("paused-none", Span.ofSeconds(10), seen, hasEnded = true).text, "ended")
