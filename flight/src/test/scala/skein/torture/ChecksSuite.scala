package skein.torture

import skein.loop.LoopKind
import skein.record.{Decision, RecordError, TrueAge}
import skein.signal.Stamped
import skein.units.*

/** The checks find what they are there to find: a clean flight's evidence is forged in one thing at a time. */
class ChecksSuite extends munit.FunSuite:

  private val clean = TortureFlight.fly(
    Ordeal
      .of(10, Span.ofSeconds(8))
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

  private def withDecision(number: Int)(change: Decision => Decision): Evidence =
    val decisions = clean.recording.decisions
    val recording = clean.recording.copy(decisions = decisions.updated(number, change(decisions(number))))
    clean.copy(recording = recording)

  test("a decision upon a reading that is older than one that had come long before"):
    val older = clean.recording.decisions(20).own
    assert(clean.recording.decisions(60).own.vehicle == older.vehicle)
    assert(found(withDecision(60)(_.copy(own = older))).contains("and had the newer"))

  test("a decision upon a reading that is older than what was decided upon before"):
    val published = clean.ordeal.copy(asPublished = true)
    val older     = clean.recording.decisions(20).own
    val forged    = withDecision(60)(_.copy(own = older)).copy(ordeal = published)
    assert(found(forged).contains("after the newer"))

  test("an answer of a run before, with a later clock, is not newer than one of the run that followed (seed 1851)"):
    def answer(validMs: Double, sentMs: Double, receivedMs: Double) =
      Stamped((), at(validMs), at(sentMs), at(receivedMs))
    def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)
    val runs = Vector(Run(at(0), Span.Zero), Run(at(34868), Span.ofMillis(4466.95)))
    val late = answer(34651.434, 34600, 35042.149)
    val next = answer(30594.875, 35000, 35129.657)
    val later = answer(30665.453, 35100, 35196.082)
    assert(!KnowledgeChecks.isNewer(runs)(late, next))
    assert(KnowledgeChecks.isNewer(runs)(later, next))
    assert(KnowledgeChecks.isNewer(Vector(runs.head))(late, next), "by the clock alone it is")

  test("a reading on record that no vehicle gave"):
    val readings = clean.recording.readings
    val forged   = readings.updated(7, readings(7).copy(sequence = readings(8).sequence + 1))
    assert(found(clean.copy(recording = clean.recording.copy(readings = forged))).contains("is not what"))

  test("ages that are not those since arrival"):
    val forged = withDecision(9): decision =>
      decision.copy(observations =
        decision.observations.copy(opponentAge = decision.observations.ownAge + Span.ofMillis(1))
      )
    assert(found(forged).contains("its opponent's data had come"))

  test("a true age beyond its uncertainty, as by an offset of the clocks with the wrong sign"):
    for change <- Seq[TrueAge => TrueAge](
        age => age.copy(own = age.own + age.uncertainty * 2 + Span.ofMillis(1)),
        age => age.copy(opponent = age.opponent - age.uncertainty * 2 - Span.ofMillis(1))
      )
    do
      val forged = withDecision(40)(decision => decision.copy(trueAge = decision.trueAge.map(change)))
      assert(found(forged).contains("ms old, told were"))

  test("rows that were offered and are not on record, or not in the file"):
    val events = clean.recording.decisions
    val less   = clean.recording.copy(decisions = events.patch(30, Nil, 1))
    assert(found(clean.copy(recording = less)).contains("are on record"))
    assert(found(clean.copy(file = Some(Right(less)))).contains("are in the file"))
    assert(found(clean.copy(file =
      Some(Right(clean.recording.copy(decisions = events.reverse)))
    )).contains("they differ"))
    assert(found(clean.copy(file =
      Some(Left(RecordError.NoSuchFile(java.nio.file.Path.of("x"))))
    )).contains("cannot be read"))

  test("a flight whose last command is not to hover, or does not come through"):
    assert(found(clean.copy(lastHovers = clean.lastHovers - "Evader")).contains("no command to hover came"))
    clean.crafts(1).act(skein.policy.Action.VelocityAt(0, 0, Metres(-20)), Span.ofSeconds(1)): Unit
    assert(found(clean).contains("Pursuer was not told to hover"))
