package skein.torture

import skein.loop.{LoopKind, FlightOutcome}
import skein.record.EventKind
import skein.scenario.PaperDuel
import skein.testing.Unhurried
import skein.units.*

/** Each kind of message fault occurs, does not end the loop, and ceases when the calm begins. */
class MischiefSimulation extends munit.FunSuite, Unhurried:
  private def flown(messageFaults: MessageFaults): FlightTrace =
    val faultPlan = FaultPlan
      .of(11, Span.ofSeconds(8))
      .copy(
        loop = LoopKind.Stream,
        scenario = PaperDuel(),
        faults = Vector.empty,
        messageFaults = messageFaults,
        restarts = Vector.empty,
        disk = Disk.Sound,
        stopAt = None
      )
    val seen = TortureFlight.fly(faultPlan)
    assertEquals(Checks.violations(seen), Vector.empty, messageFaults.toString)
    assertEquals(seen.outcome, FlightOutcome.Completed)
    seen

  private def troubles(seen: FlightTrace) =
    seen.recording.events.filter(event =>
      Set(EventKind.Refused, EventKind.TimedOut, EventKind.Disconnected)(event.kind)
    )

  private lazy val calm = flown(MessageFaults.None)

  test("without message faults, every call is answered, on two connections"):
    val stats = calm.stats
    assertEquals(
      (stats.refused, stats.timedOut, stats.lost, stats.unexpected, stats.ignored),
      (0L, 0L, 0L, 0L, 0L)
    )
    assertEquals((stats.late, stats.malformed, stats.disconnected, stats.sentAgain), (0L, 0L, 0L, 0L))
    assertEquals(troubles(calm), Vector.empty)
    assert(
      calm.mostPending >= 1 && calm.mostUnanswered >= 1 && calm.mostUnanswered <= 2,
      calm.mostPending.toString
    )

  private def mischief(what: String, messageFaults: MessageFaults)(shows: FlightTrace => Boolean): Unit =
    test(what):
      val seen = flown(messageFaults)
      assert(shows(seen), seen.stats.toString)
      val last = troubles(seen).map(_.at).maxOption.getOrElse(seen.startedAt)
      assert(
        last < seen.calmFrom + FaultPlan.ResumesWithin,
        s"trouble ${last.since(seen.calmFrom).toSeconds} s into the calm"
      )

  mischief(
    "late answers are overtaken, and come when nobody waits",
    MessageFaults(late = 0.3, lateBy = Span.ofSeconds(1.5))
  ): seen =>
    seen.stats.timedOut > 0 && seen.stats.late > 0

  mischief(
    "an answer that comes twice is known at the second time, one in five as is meant",
    MessageFaults(doubled = 0.2)
  ): seen =>
    val answered =
      seen.stats.answered * seen.calmFrom.since(seen.startedAt).toSeconds / seen.faultPlan.duration.toSeconds
    val meant = 0.2 * answered
    (seen.stats.unexpected - meant).abs < 4 * math.sqrt(0.8 * meant) && seen.stats.timedOut == 0

  mischief("strays are no answers", MessageFaults(stray = 0.5)): seen =>
    seen.stats.unexpected + seen.stats.ignored > 10 && seen.stats.ignored > 0 && seen.stats.unexpected > 0

  mischief("garbage ends its connection, and another is made", MessageFaults(garbage = 0.05)): seen =>
    seen.stats.disconnected > 0 && seen.stats.connected > calm.stats.connected

  mischief("a move under an unknown name is refused", MessageFaults(refused = 0.4)): seen =>
    seen.stats.refused > 0 && seen.arrivals.size < seen.ports.map(_.sendings.size).sum

  mischief("a lost answer is missed after its time", MessageFaults(lost = 0.2)): seen =>
    seen.stats.timedOut > 0 && seen.stats.late == 0 && seen.stats.disconnected == 0

  mischief("an answer of another type is an error on record, not a reading", MessageFaults(nonsense = 0.3)):
    seen =>
      seen.recording.readings.size < seen.ports.map(_.reads.begun).sum && seen.stats.timedOut == 0

  test("all given seeds run, each once, several in parallel"):
    var told = Vector.empty[Long]
    Torture.all(Iterator(1L, 2L, 3L, 4L), FaultPlan.Shortest, threads = 2)(verdict =>
      told :+= verdict.faultPlan.seed
    )
    assertEquals(told.sorted, Vector(1L, 2L, 3L, 4L))
    var few = Vector.empty[FaultVerdict]
    Torture.all(Iterator(5L), FaultPlan.Shortest, threads = 3)(few :+= _)
    assertEquals(few.map(verdict => (verdict.faultPlan.seed, verdict.isClean)), Vector((5L, true)))
    assert(!few.head.copy(violations = Vector("a command overtook a newer one")).isClean)
