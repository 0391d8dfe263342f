package skein.torture

import scala.concurrent.ExecutionContext
import skein.flight.CameraSensor
import skein.loop.{LoopKind, FlightOutcome}
import skein.record.{DecisionRow, Event, EventKind, EventSubject, RecordError, TrueAge}
import skein.policy.*
import skein.scenario.{PaperDuel, Scenario}
import skein.signal.Stamped
import skein.testing.Unhurried
import skein.units.*

/** Each check finds its violation: the trace of a clean flight is forged in one detail after another. */
class ChecksSimulation extends munit.FunSuite, Unhurried:
  private val clean = undisturbed(LoopKind.Stream)

  private def undisturbed(loop: LoopKind, scenario: Scenario = PaperDuel()): FlightTrace = TortureFlight.fly(
    FaultPlan
      .of(10, Span.ofSeconds(8))
      .copy(
        loop = loop,
        scenario = scenario,
        faults = Vector.empty,
        messageFaults = MessageFaults.None,
        restarts = Vector.empty,
        disk = Disk.Sound,
        stopAt = None,
        looks = false
      )
  )

  private def found(forged: FlightTrace): String = Checks.violations(forged).mkString("\n")

  test("the checks find nothing in a flight without faults"):
    assertEquals(Checks.violations(clean), Vector.empty)
    assert(clean.arrivals.size > 50)

  for loop <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Predictive, LoopKind.Paused) do
    test(s"${loop.label}: the checks find nothing without faults, and find a decision at another time"):
      val seen = undisturbed(loop)
      assertEquals(Checks.violations(seen), Vector.empty)
      val decisions = seen.recording.decisions
      val later     = decisions(30).copy(decidedAt = decisions(30).decidedAt + Span.ofNanos(1))
      val forged    = seen.copy(recording = seen.recording.copy(decisions = decisions.updated(30, later)))
      val told = if loop == LoopKind.Predictive || loop == LoopKind.Paused then "had come" else "no round"
      assert(found(forged).contains(told), found(forged))

  /** Flies to a place, turns, and flies on. */
  private case class Patrol() extends Scenario:
    private object Still extends Policy:
      type Memory = Unit
      def start: Unit                                             = ()
      def choose(seen: Observation, memory: Unit): (Action, Unit) =
        val action = (seen.decisions / 10) % 3 match
          case 0 => Action.Position(Vector3(10, 0, -20), MetresPerSecond(3))
          case 1 => Action.Turn(Yaw.Turning(0.5))
          case _ => Action.Velocity(Vector3(1, 0, 0))
        (action, ())
    def agents: Vector[Agent] =
      Vector(Agent("Scout", Role.Traveller, MetresPerSecond(3), Vector3(0, 0, -20), Radians(0), Still))

  test("commands that are not velocities are distinguished only by their order"):
    val seen = undisturbed(LoopKind.Stream, Patrol())
    assertEquals(Checks.violations(seen), Vector.empty)
    assert(
      seen.arrivals.count(_.north == 0) > 20 && seen.arrivals.exists(_.north == 1),
      seen.arrivals.toString
    )

  test("the checks find a command that arrives after a newer one"):
    val evaders        = clean.arrivals.indices.filter(clean.arrivals(_).vehicle == "Evader")
    val (first, later) = (evaders(40), evaders(41))
    val swapped        =
      clean.arrivals.updated(first, clean.arrivals(later)).updated(later, clean.arrivals(first))
    assert(found(clean.copy(arrivals = swapped)).contains("overtook a newer one"))

  test("the checks find commands that cease"):
    val until = clean.startedAt + Span.ofSeconds(4)
    assert(found(clean.copy(arrivals =
      clean.arrivals.filter(_.at < until)
    )).contains("no command for 2.00 s in calm"))
    val one = found(clean.copy(arrivals =
      clean.arrivals.filter(arrival => arrival.at < until || arrival.vehicle == "Pursuer")
    ))
    assert(one.contains("Evader: no command for") && !one.contains("Pursuer: no command for"), one)

  test("the checks find a call that never ended"):
    val stats = clean.stats.copy(answered = clean.stats.answered - 1)
    assert(found(clean.copy(stats = stats)).contains("1 calls that never ended"))

  test("the checks find a missing reading, command and acknowledgement in the recording"):
    val recording = clean.recording
    val without   = Seq(
      recording.copy(readings = recording.readings.tail),
      recording.copy(commands = recording.commands.tail),
      recording.copy(acknowledgements = recording.acknowledgements.tail)
    )
    for forged <- without do
      assert(found(clean.copy(recording = forged)).contains("on record"), forged.flight.id)

  test("the checks find a rate above the limit, and too many pending calls"):
    assert(found(clean.copy(settings =
      clean.settings.copy(minCommandInterval = Span.ofMillis(300))
    )).contains("two commands within"))
    assert(found(clean.copy(mostPending = 1000)).contains("1000 calls were under way at once"))
    assert(found(clean.copy(mostUnanswered = 5)).contains("5 unanswered moves"))

  test("the checks accept values at their limits"):
    val most = clean.vehicles.size * (clean.settings.window + 3L)
    assertEquals(found(clean.copy(mostPending = most, mostUnanswered = 4)), "")
    assert(found(clean.copy(mostPending = most + 1)).contains(s"of $most at most"))
    assertEquals(found(clean.copy(drifts = Vector(Metres(14), Metres(14)))), "")
    assert(found(clean.copy(drifts = Vector(Metres(14.001), Metres(0)))).contains("flies on after the end"))
    val gaps =
      for port <- clean.ports; (one, next) <- port.sendings.zip(port.sendings.tail)
      yield next.at.since(one.at)
    assertEquals(found(clean.copy(settings = clean.settings.copy(minCommandInterval = gaps.min))), "")
    assert(found(clean.copy(settings =
      clean.settings.copy(minCommandInterval = gaps.min + Span.ofNanos(1))
    )).contains("two commands within"))

  test("the checks find a third unanswered command, and calls of vehicles and stepper that did not end"):
    val counts = clean.ports.head.commands
    val most   = counts.most
    counts.most = 3
    try assert(found(clean).contains("Evader: 3 commands were outstanding at once"))
    finally counts.most = most
    counts.ended -= 1
    try assert(found(clean).contains(s"Evader: ${counts.begun} command calls began, ${counts.ended} ended"))
    finally counts.ended += 1
    val steps = CallCount()
    steps.begun = 2
    steps.ended = 1
    assert(found(clean.copy(steps = steps)).contains("2 calls of the stepper began, 1 ended"))
    assertEquals(found(clean), "")

  test("the checks find counts of calls made, written and answered that disagree"):
    val stats = clean.stats
    val calls = clean.copy(stats = stats.copy(called = stats.called + 1, answered = stats.answered + 1))
    assert(
      found(calls).contains(s"was to be called ${stats.called} times, and was ${stats.called + 1} times")
    )
    val written = clean.copy(stats = stats.copy(sent = stats.called + 1))
    assert(found(written).contains(s"${stats.called + 1} calls were written of ${stats.called}"))
    assertEquals(found(clean.copy(stats = stats.copy(sent = stats.sent + 3, sentAgain = 3))), "")
    val unwritten = clean.copy(stats = stats.copy(sent = stats.answered - 1))
    assert(found(unwritten).contains(s"0 refused and 0 lost of ${stats.answered - 1} that were written"))
    val twice = clean.copy(arrivals = clean.arrivals.flatMap(arrival => Vector.fill(2)(arrival)))
    assert(found(
      twice
    ).contains(s"${twice.arrivals.size} moves arrived of ${clean.ports.map(_.sendings.size).sum}"))

  test("the checks find images that were counted as neither missed, lost nor searched"):
    val counts = CameraSensor.Counts(due = 80, missed = 10, lost = 5, searched = 65)
    val forged = clean.copy(
      images = Vector(counts),
      stats = clean.stats.copy(
        called = clean.stats.called + counts.asked,
        sent = clean.stats.sent + counts.asked,
        answered = clean.stats.answered + counts.asked
      )
    )
    assertEquals(found(forged), "")
    assertEquals(
      found(forged.copy(images = Vector(counts.copy(lost = 4)))),
      "of 80 images that were due 10 were missed, 4 lost, 65 searched"
    )

  test("the checks find a written call that was neither answered, refused nor lost"):
    val stats = clean.stats
    val mixed = stats.copy(answered = stats.answered - 5, refused = 3, lost = 2)
    assertEquals(found(clean.copy(stats = mixed)), "")
    val short = found(clean.copy(stats = mixed.copy(sent = stats.sent - 1)))
    assert(short.contains(s"${mixed.answered} answered, 3 refused and 2 lost of ${stats.sent - 1}"), short)

  test("the checks require an event of its vehicle for each failed reading"):
    val recording                                           = clean.recording
    val lost                                                = recording.readings.head
    def noted(vehicle: String, about: Option[EventSubject]) =
      val event = Event(clean.endedAt, EventKind.TimedOut, Some(vehicle), "no answer", about = about)
      val less  = recording.copy(readings = recording.readings.tail, events = recording.events :+ event)
      found(clean.copy(recording = less)).contains("readings were asked for")
    val other = clean.vehicles.filterNot(_ == lost.vehicle).head
    assert(!noted(lost.vehicle, Some(EventSubject.Reading)))
    assert(noted(other, Some(EventSubject.Reading)) && noted(lost.vehicle, None))

  test(
    "the checks find more recorded commands than decisions, and more rows than the flight's length allows"
  ):
    val recording = clean.recording
    val less      = recording.copy(decisions = recording.decisions.filterNot(_.vehicle == "Evader"))
    assert(found(clean.copy(recording = less)).contains("Evader: 0 decisions led to"))
    val short = clean.copy(endedAt = clean.startedAt + Span.ofMillis(1))
    assert(found(short).contains("are many for this flight"), found(short))
    val steps = CallCount()
    steps.begun = 80
    steps.ended = 80
    assert(!found(short.copy(steps = steps)).contains("are many for this flight"), "80 steps are 8 s")
    val few = CallCount()
    few.begun = 1
    few.ended = 1
    assert(
      found(short.copy(
        steps = few,
        settings = short.settings.copy(period = Span.ofMillis(10))
      )).contains("are many for this flight"),
      "one step is 10 ms"
    )
    // As published every vehicle decides at every reading of any: 340 rows per second for each of two, not
    // 300.
    val rows   = Recorded.rows(clean.recording)
    val flown  = Span.ofSeconds(rows / (2 * 325.0) - 1)
    val dense  = clean.copy(endedAt = clean.startedAt + flown)
    val tapped = dense.copy(faultPlan = clean.faultPlan.copy(scenario = PaperDuel(asPublished = true)))
    assert(found(dense).contains("are many for this flight"))
    assert(!found(tapped).contains("are many for this flight"), found(tapped))

  test("the checks find control that does not resume after the faults: no decision on new data, no command"):
    val due = clean.calmFrom + FaultPlan.ResumesWithin
    val old = clean.recording.copy(decisions =
      clean.recording.decisions.filterNot(decision =>
        decision.own.state.sentAt >= clean.calmFrom && decision.decidedAt < due
      )
    )
    assert(found(clean.copy(recording =
      old
    )).contains("Pursuer: nothing was decided on a new reading within 3"))
    val silent = clean.copy(arrivals =
      clean.arrivals.filter(arrival => arrival.at < clean.calmFrom || arrival.at >= due)
    )
    assert(found(silent).contains("Evader: no command came within 3"))
    assert(!found(silent.copy(outcome = FlightOutcome.Stopped)).contains("no command came within"))
    assert(!found(silent.copy(endedAt = due - Span.ofMillis(1))).contains("no command came within"))
    val paused = silent.copy(faultPlan = clean.faultPlan.copy(loop = LoopKind.Paused))
    assert(!found(paused).contains("no command came within"))

  test(
    "the checks require control from three seconds after the faults until the flight's time has elapsed"
  ):
    val due    = clean.calmFrom + FaultPlan.ResumesWithin
    val silent = clean.copy(arrivals =
      clean.arrivals.filter(arrival => arrival.at < clean.calmFrom || arrival.at >= due)
    )
    assert(found(silent.copy(endedAt = due)).contains("no command came within"))
    // Nothing is commanded while the last answers are awaited.
    val waited = clean.copy(endedAt = clean.endedAt + Span.ofSeconds(3))
    assert(!found(waited).contains("no command for"), found(waited))
    val begun = clean.copy(arrivals = clean.arrivals.filter(_.at < due))
    assert(!found(begun.copy(endedAt = due + Span.ofSeconds(1.5))).contains("no command for"))
    val late = found(begun.copy(endedAt = due + Span.ofSeconds(1.5) + Span.ofNanos(1)))
    assert(late.contains("no command for 1.50 s in calm"), late)

  test("the checks require commands to arrive from three seconds after the faults on"):
    val due    = clean.calmFrom + FaultPlan.ResumesWithin
    val before = due - Span.ofNanos(1)
    assert(found(clean.copy(leftPaused = true, endedAt = due)).contains("left standing still"))
    val unheard = clean.copy(lastHovers = Map.empty)
    assert(found(unheard.copy(endedAt = due)).contains("no command to hover came"))
    assert(!found(unheard.copy(endedAt = before)).contains("no command to hover came"))
    val lastMoves = clean.vehicles.map(name => name -> clean.arrivals.filter(_.vehicle == name).map(_.at).max)
    assertEquals(found(clean.copy(lastHovers = lastMoves.toMap)), "", "at the same moment is in time")
    val early = lastMoves.toMap.map((name, at) => name -> (at - Span.ofNanos(1)))
    assert(found(clean.copy(lastHovers = early)).contains("Evader: no command to hover came"))
    val one = found(unheard.copy(arrivals = clean.arrivals.filter(_.vehicle == "Pursuer")))
    assert(one.contains("Pursuer: no command to hover came") && !one.contains("Evader: no command to hover"))
    val still = unheard.copy(arrivals = Vector.empty)
    assert(!found(still).contains("no command to hover came"), "who never moved need not be told")

  test("the checks find a simulator that was not resumed by a flight that had time for it"):
    val still = clean.copy(leftPaused = true)
    assert(found(still).contains("left standing still"))
    assert(!found(still.copy(endedAt = clean.calmFrom + Span.ofSeconds(2.9))).contains("left standing still"))

  test("the checks accept the beginning of a recording after a failed flight"):
    val begun = clean.recording.copy(readings = clean.recording.readings.take(10))
    val cut   = clean.copy(recording = begun, outcome = FlightOutcome.Failed("the disk is full"))
    assert(!found(cut).contains("readings were asked for"))
    assert(found(cut.copy(outcome = FlightOutcome.Completed)).contains("readings were asked for"))

  test(
    "the checks do not compare reports from before a simulator's restart with later ones"
  ):
    def restarted(atS: Double, jump: Span) = clean.copy(runs =
      clean.runs :+ Run(clean.startedAt + Span.ofSeconds(atS), clean.runs.head.clockOffset + jump)
    )
    val wrong = "ms old, told were"
    for seconds <- Seq(100.0, -100.0, 1.0, -1.0) do
      assert(found(restarted(4, Span.ofSeconds(seconds))).contains(wrong), s"$seconds s")
    // A jump that no answer shows is not checked, nor are readings while old answers may still arrive.
    for seconds <- Seq(0.5, -0.5) do
      assert(!found(restarted(4, Span.ofSeconds(seconds))).contains(wrong), s"$seconds s")
    assert(!found(restarted(7.3, Span.ofSeconds(100))).contains(wrong))
    assertEquals(found(restarted(4, Span.Zero)), "")
    // 0.7 s until requests to the old run are over, and 0.7 s more until the first answer of the new one is
    // known.
    val first = found(restarted(4, Span.ofSeconds(100))) match
      case s"${_}decision $number of $vehicle: ${_}" =>
        clean.recording.decisions.find(one => one.vehicle == vehicle && one.sequence == number.toLong).get
      case other => fail(other)
    assertEqualsDouble(first.decidedAt.since(clean.startedAt).toSeconds, 5.5, 0.1)
    // The new clock is unknown until every vehicle has answered by it.
    val silent = WatchedVehicle(clean.ports.head, Clock.system)(using ExecutionContext.parasitic)
    assert(!found(restarted(4, Span.ofSeconds(100)).copy(ports = clean.ports :+ silent)).contains(wrong))
    // Of three runs only two are alike.
    val again = restarted(4, Span.ofSeconds(0.5))
    val third = Run(clean.startedAt + Span.ofSeconds(4.5), clean.runs.head.clockOffset + Span.ofSeconds(100))
    assert(!found(again.copy(runs = again.runs :+ third)).contains(wrong))

  test("the checks find a vehicle that does not hover after the end"):
    assert(found(clean.copy(drifts =
      Vector(Metres(0.1), Metres(18))
    )).contains("Pursuer flies on after the end: 18.0 m in 4 s"))

  private def withDecision(number: Int)(change: DecisionRow => DecisionRow): FlightTrace =
    val decisions = clean.recording.decisions
    val recording = clean.recording.copy(decisions = decisions.updated(number, change(decisions(number))))
    clean.copy(recording = recording)

  test("the checks find a decision on a reading older than one received long before"):
    val older = clean.recording.decisions(20).own
    assert(clean.recording.decisions(60).own.vehicle == older.vehicle)
    assert(found(withDecision(60)(_.copy(own = older))).contains("and had the newer"))

  test("the checks find a decision on a reading older than that of an earlier decision"):
    val published = clean.faultPlan.copy(scenario = PaperDuel(asPublished = true))
    val older     = clean.recording.decisions(20).own
    val forged    = withDecision(60)(_.copy(own = older)).copy(faultPlan = published)
    assert(found(forged).contains("after the newer"))

  test(
    "an answer of an earlier run with a later clock is not newer than one of the next run (seed 1851)"
  ):
    def answer(validMs: Double, sentMs: Double, receivedMs: Double) =
      Stamped((), at(validMs), at(sentMs), at(receivedMs))
    def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)
    val runs           = Vector(Run(at(0), Span.Zero), Run(at(34868), Span.ofMillis(4466.95)))
    val late           = answer(34651.434, 34600, 35042.149)
    val next           = answer(30594.875, 35000, 35129.657)
    val later          = answer(30665.453, 35100, 35196.082)
    assert(!KnowledgeChecks.isNewer(runs)(late, next))
    assert(KnowledgeChecks.isNewer(runs)(next, late), "though its clock is the earlier one")
    assert(KnowledgeChecks.isNewer(runs)(later, next))
    val atOnce = answer(34992.9, 34900, 35100)
    val again  = answer(34992.9 - 4466.95, 34990, 35110)
    assert(!KnowledgeChecks.isNewer(runs)(again, atOnce) && !KnowledgeChecks.isNewer(runs)(atOnce, again))
    assert(KnowledgeChecks.isNewer(Vector(runs.head))(late, next), "by the clock alone it is")

  test("with an unknown clock, a report is newer if both clocks, or the times of request, show it"):
    def answer(validMs: Double, sentMs: Double, receivedMs: Double) =
      def at(ms: Double) = Instant.Epoch + Span.ofMillis(ms)
      Stamped((), at(validMs), at(sentMs), at(receivedMs))
    def newer(one: Stamped[Unit], other: Stamped[Unit]) = KnowledgeChecks.isNewer(Vector.empty)(one, other)
    val held                                            = answer(100, 80, 90)
    assert(newer(answer(101, 80, 95), held) && !newer(held, answer(101, 80, 95)))
    assert(
      newer(answer(50, 91, 95), held) == newer(held, answer(50, 91, 95)),
      "one says so, the other does not"
    )
    assert(newer(answer(100, 91, 95), held) && !newer(answer(100, 90, 95), held))

  test("the checks find a recorded reading that no vehicle gave"):
    val readings = clean.recording.readings
    val forged   = readings.updated(7, readings(7).copy(sequence = readings(8).sequence + 1))
    assert(found(clean.copy(recording = clean.recording.copy(readings = forged))).contains("is not what"))

  test("the checks find ages that do not count from arrival"):
    val forged = withDecision(9): decision =>
      decision.copy(observations =
        decision.observations.copy(opponentAge = decision.observations.ownAge + Span.ofMillis(1))
      )
    assert(found(forged).contains("its opponent's data had come"))

  test(
    "the checks find a true age that is wrong by more than its uncertainty, as with an offset of wrong sign"
  ):
    for change <- Seq[TrueAge => TrueAge](
        age => age.copy(own = age.own + age.uncertainty * 2 + Span.ofMillis(1)),
        age => age.copy(opponent = age.opponent - age.uncertainty * 2 - Span.ofMillis(1))
      )
    do
      val forged = withDecision(40)(decision => decision.copy(trueAge = decision.trueAge.map(change)))
      assert(found(forged).contains("ms old, told were"))

  test("the checks accept a true age within its uncertainty, in both directions"):
    val decision       = clean.recording.decisions(40)
    val told           = decision.trueAge.get
    val old            = decision.decidedAt.since(decision.own.state.validAt + clean.runs.head.clockOffset)
    def age(off: Span) =
      found(withDecision(40)(_.copy(trueAge =
        Some(told.copy(own = old + off))
      ))).contains("ms old, told were")
    assert(!age(told.uncertainty) && !age(Span.Zero - told.uncertainty))
    assert(age(told.uncertainty + Span.ofNanos(1)) && age(Span.Zero - told.uncertainty - Span.ofNanos(1)))

  test("the checks find offered rows that are missing in the recording or its file"):
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

  test("the checks find a flight whose last command is not to hover, or does not arrive"):
    assert(found(clean.copy(lastHovers = clean.lastHovers - "Evader")).contains("no command to hover came"))
    clean.ports(1).act(skein.policy.Action.VelocityAt(0, 0, Metres(-20)), Span.ofSeconds(1)): Unit
    assert(found(clean).contains("Pursuer was not told to hover"))
