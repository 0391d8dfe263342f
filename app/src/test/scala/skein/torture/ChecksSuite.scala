package skein.torture

import skein.loop.LoopKind
import skein.units.*

/** The checks find what they are there to find: a clean flight's evidence is forged in one thing at a time. */
class ChecksSuite extends munit.FunSuite:

  private val clean = TortureFlight.fly(
    Ordeal
      .of(1, Span.ofSeconds(8))
      .copy(
        loop = LoopKind.Stream,
        pairs = 1,
        asPublished = false,
        faults = Vector.empty,
        meddling = Meddling.None,
        restarts = Vector.empty,
        disk = Disk.Sound,
        stopAt = None
      )
  )

  private def found(forged: Evidence): String = Checks.violations(forged).mkString("\n")

  test("a flight in which nothing goes wrong is clean"):
    assertEquals(Checks.violations(clean), Vector.empty)
    assert(clean.arrivals.size > 50)

  test("a command that arrives after a newer one"):
    val evaders        = clean.arrivals.indices.filter(clean.arrivals(_).vehicle == "Evader")
    val (first, later) = (evaders(40), evaders(41))
    val swapped        =
      clean.arrivals.updated(first, clean.arrivals(later)).updated(later, clean.arrivals(first))
    assert(found(clean.copy(arrivals = swapped)).contains("overtook a newer one"))

  test("commands that stop coming"):
    val until = clean.startedAt + Span.ofSeconds(4)
    assert(found(clean.copy(arrivals =
      clean.arrivals.filter(_.at < until)
    )).contains("no command for 2.00 s in calm"))

  test("a call that never ended"):
    val stats = clean.stats.copy(answered = clean.stats.answered - 1)
    assert(found(clean.copy(stats = stats)).contains("1 calls that never ended"))

  test("a reading, a command and an acknowledgement that are not on record"):
    val recording = clean.recording
    val without   = Seq(
      recording.copy(readings = recording.readings.tail),
      recording.copy(commands = recording.commands.tail),
      recording.copy(acknowledgements = recording.acknowledgements.tail)
    )
    for forged <- without do
      assert(found(clean.copy(recording = forged)).contains("on record"), forged.flight.id)

  test("a rate above the cap, and too many calls under way"):
    assert(found(clean.copy(minCommandInterval = Span.ofMillis(300))).contains("two commands within"))
    assert(found(clean.copy(mostPending = 1000)).contains("1000 calls were under way at once"))
    assert(found(clean.copy(mostUnanswered = 5)).contains("5 unanswered moves"))

  test("a vehicle that does not hover after the end"):
    assert(found(clean.copy(drifts =
      Vector(Metres(0.1), Metres(18))
    )).contains("Pursuer flies on after the end: 18.0 m in 4 s"))
