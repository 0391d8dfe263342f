package skein.solver

import skein.loop.*
import skein.policy.*
import skein.record.{EventKind, ParameterRow, Recording}
import skein.scenario.{Crossing, PaperDuel}
import skein.signal.{LatencyProfile, SplitMix64}
import skein.solver.SolverTrial.To
import skein.testing.Optimised
import skein.units.*

/** Whole flights with a remote solver in virtual time: one that is slow, dies, restarts, answers twice, or
  * answers in another order.
  */
class SolverSimulation extends munit.FunSuite, Optimised:
  private val fleet = PaperDuel().fleet

  /** The recording as a flight with that fallback makes it. */
  private def hovering(recording: Recording): Recording =
    val fallback = ParameterRow(Replay.Fallback, Fallback.Hover.label)
    recording.copy(heading = recording.heading.copy(parameters = recording.heading.parameters :+ fallback))

  private def checked(
      trial: SolverTrial,
      fleet: Fleet = fleet,
      answers: Recording => Int = _.solved.size
  ): SolverTrial =
    val recording = trial.recording
    assertEquals(trial.outcome, FlightOutcome.Completed)
    assertEquals(
      Replay(fleet, hovering(recording), LoopSettings(planning = SolverTrial.planning)).firstDifference,
      None
    )
    for (vehicle, solved) <- recording.solved.groupBy(_.vehicle) do
      val numbers = solved.map(_.question)
      assertEquals(numbers, numbers.sorted.distinct, s"$vehicle used answers out of order")
      for one <- solved do assert(one.roundTrip < SolverTrial.within, s"$one came too late")
    // Every decision has one maker.
    val made = recording.solved.map(one => (one.vehicle, one.decision)).toSet
    assertEquals(made intersect trial.byFallback, Set.empty)
    assertEquals(
      made union trial.byFallback,
      recording.decisions.map(decision => (decision.vehicle, decision.sequence)).toSet
    )
    // Every answer has one fate; the last may arrive after the flight's end.
    val unused = trial.counts.used - answers(recording)
    assert(unused >= 0 && unused <= fleet.agents.size, trial.counts)
    assertEquals(trial.counts.late, trial.events(EventKind.LateReply).size.toLong)
    trial

  for
    (name, rehearsals, fate, expected) <- Seq[(String, Int, (To, Int) => Seq[Span], Range)](
      ("all arrive", 30, (_, _) => Seq(Span.ofMillis(5)), 31 to 31),
      // The ninth message is lost: greeted again after half a second.
      ("one is lost", 30, (_, sent) => if sent == 9 then Nil else Seq(Span.ofMillis(5)), 31 to 32),
      ("they take long, and after 3 s it flies", 1000, (_, _) => Seq(Span.ofMillis(100)), 15 to 100)
    )
  do
    test(s"a client rehearses a link by greetings before its first request, and sends none after it: $name"):
      var sent  = Vector.empty[Boolean]
      val trial = SolverTrial.fly(fate = fate, rehearsals = rehearsals)(hand =>
        hand.at(4)(hand.breakLink("cut"))
        hand.at(4.5)(hand.mendLink())
        hand.at(5.3) { sent = hand.greetings.result() }
      )
      assertEquals(trial.outcome, FlightOutcome.Completed)
      assert(clue(expected).contains(clue(sent.takeWhile(identity).size)))
      assert(clue(sent.dropWhile(identity).count(identity)) <= 3)

  test(
    "remote decisions are at the solver's time on the controller's clock, and replay from the recording"
  ):
    val trial = checked(SolverTrial.fly(takes = _ => Span.ofMillis(20))())
    assert(trial.recording.decisions.size > 100)
    assertEquals(trial.events(EventKind.DeadlineMissed), Vector.empty)
    val bySequence = trial.recording.solved.map(one => (one.vehicle, one.decision) -> one).toMap
    for decision <- trial.recording.decisions.drop(20) do
      val one = bySequence((decision.vehicle, decision.sequence))
      assertEqualsDouble(decision.decidedAt.since(one.askedAt).toMillis, 5, 0.01)
      assertEqualsDouble(one.clock.get.offset.toSeconds, 7, 1e-5)
      assertEqualsDouble(one.roundTrip.toMillis, 30, 1e-9)
      assertEqualsDouble(one.thinking.toMillis, 20, 1e-9)

  test("a prediction is for the time at which a remotely decided command acts"):
    def ahead(hopMs: Double) =
      val trial = SolverTrial.fly(fate = (_, _) => Seq(Span.ofMillis(hopMs)))()
      val made  = trial.recording.decisions.drop(20)
      val late  = trial.recording.predictions.map(_.error.value).sorted
      assert(late(late.size * 9 / 10) < 0.02, s"predictions are off by ${late(late.size * 9 / 10)} m")
      made.map(decision =>
        decision.predicted.get.actsAt.since(decision.own.state.validAt).toMillis
      ).sum / made.size
    assertEqualsDouble(ahead(20) - ahead(5), 30, 3)

  test("late answers of a slow solver are not used, and vehicles hover"):
    val slow  = 40L
    val trial = checked(SolverTrial.fly(
      takes = question => if question.number >= slow then Span.ofMillis(130) else Span.Zero
    )())
    val after = trial.recording.decisions.filter(_.sequence > slow)
    assert(after.nonEmpty && after.forall(_.action.contains(Action.Hover)))
    assert(trial.counts.late > 5, trial.counts)
    // The newest wins: those that waited meanwhile were skipped.
    assert(trial.counts.overtaken > 0 || trial.questions.size > 60, trial.counts)

  test("when a solver dies and is restarted, vehicles hover meanwhile, and fly on"):
    val trial = checked(SolverTrial.fly(): hand =>
      hand.at(2)(hand.kill())
      hand.at(4)(hand.start(2)))
    val hovering = trial.recording.decisions.filter(_.action.contains(Action.Hover))
    for vehicle <- fleet.agents.map(_.name) do
      val own = hovering.filter(_.vehicle == vehicle).map(_.decidedAt.toSeconds)
      assert(own.size >= 15, s"$vehicle hovered ${own.size} times")
      assert(trial.recording.decisions.filter(_.vehicle == vehicle).last.action.isEmpty, vehicle)
    assertEquals(
      trial.events(EventKind.SolverRestarted).flatMap(_.vehicle).toSet,
      fleet.agents.map(_.name).toSet
    )

  test("a lost link fails immediately, and its loss and return are reported"):
    val trial = checked(SolverTrial.fly(): hand =>
      hand.at(2)(hand.breakLink("cut"))
      hand.at(3)(hand.mendLink()))
    assertEquals(trial.events(EventKind.Disconnected).map(_.detail), Vector("the solver is lost: cut"))
    assertEquals(trial.events(EventKind.Reconnected).size, 1)
    assert(trial.events(EventKind.DeadlineMissed).exists(_.detail.contains("Failed(cut)")))
    assertEquals(trial.events(EventKind.SolverRestarted), Vector.empty)

  test("repeated answers and requests count once"):
    val trial = checked(SolverTrial.fly(fate = (_, _) => Seq(Span.ofMillis(5), Span.ofMillis(9)))())
    assertEquals(trial.events(EventKind.DeadlineMissed), Vector.empty)
    assert(trial.counts.repeated > 50, trial.counts)
    assert(trial.counts.repeatedThere > 50, trial.counts)
    assertEquals(trial.questions.distinct, trial.questions)

  test("with messages lost, repeated and reordered at random, nothing overtakes, and the decisions replay"):
    for seed <- 1L to 20L do
      val random                       = SplitMix64(seed)
      val fate: (To, Int) => Seq[Span] = (_, number) =>
        val share = random.nextDouble()
        val one   = Span.ofMillis(1 + 20 * random.nextDouble())
        if number < 6 then Seq(one)
        else if share < 0.1 then Nil
        else if share < 0.2 then Seq(one, one + Span.ofMillis(200 * random.nextDouble()))
        else if share < 0.3 then Seq(Span.ofMillis(90 + 300 * random.nextDouble()))
        else Seq(one)
      val trial = checked(SolverTrial.fly(seed = seed, seconds = 4, fate = fate): hand =>
        hand.at(2)(hand.start(2)))
      for (_, asked) <- trial.questions.groupBy(one => (one.solver, one.vehicle)) do
        val numbers = asked.map(_.number)
        assertEquals(
          numbers,
          numbers.sorted,
          s"seed $seed: the solver decided an older question after a newer one"
        )
      assert(trial.recording.solved.size > 30, s"seed $seed: ${trial.counts}")

  test(
    "a policy with a memory continues from the answer that was used, and restarts after a solver's restart"
  ):
    val counting = SolverSimulation.Counting
    val team     =
      Fleet(fleet.agents.map(agent =>
        if agent.role == Role.Pursuer then agent.copy(policy = counting) else agent
      ))
    val trial = checked(
      SolverTrial.fly(
        fleet = team,
        takes = question => if question.number % 10 == 9 then Span.ofMillis(150) else Span.Zero
      )(hand => hand.at(3)(hand.start(2))),
      team
    )
    assert(trial.counts.late >= 5, trial.counts)
    assert(trial.events(EventKind.SolverRestarted).exists(_.vehicle.contains("Pursuer")))
    // Without the record of the restart, the replay's memory differs.
    assertEquals(Replay(team, unsaid(trial.recording)).firstDifference.map(_.column), Some("headingRad"))

  private def unsaid(recording: Recording): Recording =
    hovering(recording.copy(events = recording.events.filter(_.kind != EventKind.SolverRestarted)))

  test(
    "remote plans replay; vehicles hover while the solver is slow or restarts"
  ):
    val trial = checked(SolverTrial.fly(
      kind = LoopKind.Plan,
      takes = question => if question.number % 10 == 9 then Span.ofMillis(50) else Span.Zero
    ): hand =>
      hand.at(2)(hand.kill())
      hand.at(3)(hand.start(2)))
    val pursuer = trial.recording.solved.filter(_.vehicle == "Pursuer")
    assertEquals(trial.recording.planned.map(_.decision), pursuer.map(_.decision))
    assert(pursuer.size > 30, pursuer.size)
    for one <- pursuer do assert(one.roundTrip.toMillis >= 70, one)
    assert(trial.byFallback.count(_._1 == "Pursuer") > 10, trial.byFallback)
    assert(trial.events(EventKind.SolverRestarted).exists(_.vehicle.contains("Pursuer")))

  test("one request plans a whole team, and an answer decides either for all of its vehicles or for none"):
    val team  = Crossing(vehicles = 4).fleet
    val trial = checked(
      SolverTrial.fly(kind = LoopKind.Plan, fleet = team, seconds = 10): hand =>
        hand.at(2)(hand.kill())
        for start <- 2 to 9 do hand.at(start + 0.5)(hand.start(start))
      ,
      team,
      _.solved.map(_.question).distinct.size
    )
    val together = trial.recording.decisions.groupBy(_.sequence).values
    assert(together.sizeIs > 30, together.size)
    for made <- together do
      assertEquals(made.map(_.vehicle).toSet, team.agents.map(_.name).toSet)
      assertEquals(made.map(_.decidedAt).distinct.size, 1)
      assertEquals(made.map(_.action.contains(Action.Hover)).distinct.size, 1)
    assertEquals(trial.recording.planned.size, trial.recording.solved.size)
    assert(trial.byFallback.nonEmpty)
    // A plan continues the last one that was used, and differs if that is unknown.
    assert(trial.events(EventKind.SolverRestarted).nonEmpty)
    assert(Replay(
      team,
      unsaid(trial.recording),
      LoopSettings(planning = SolverTrial.planning)
    ).firstDifference.isDefined)

  test("a prediction is for the time at which a remotely planned command acts"):
    def ahead(hopMs: Double) =
      val fate: (To, Int) => Seq[Span] = (_, _) => Seq(Span.ofMillis(hopMs))
      val made = checked(SolverTrial.fly(kind = LoopKind.Plan, fate = fate)()).recording.decisions
        .filter(_.vehicle == "Pursuer")
        .drop(20)
      made.map(decision =>
        decision.predicted.get.actsAt.since(decision.own.state.validAt).toMillis
      ).sum / made.size
    assertEqualsDouble(ahead(15) - ahead(5), 20, 3)

  test("equal seeds give equal recordings"):
    assertEquals(SolverTrial.fly(seed = 3)().recording, SolverTrial.fly(seed = 3)().recording)

  test("over vpn, predictive with its solver behind a separate link flies within 2 % of the paused flight"):
    val seeds = 1L to 3L
    for (name, median) <- Seq("a broker's" -> 4.0, "a slower" -> 30.0) do
      val flown = seeds.map: seed =>
        val random                       = SplitMix64(seed)
        val fate: (To, Int) => Seq[Span] = (_, _) =>
          Seq(Span.ofMillis(median / 2 * (0.5 + random.nextExponential(0.7))))
        checked(SolverTrial.fly(seed = seed, seconds = 60, link = LatencyProfile.vpn, fate = fate)())
      val off = flown.map(_.distanceM).sum / seeds.size / VirtualGame.truth.distanceM - 1
      assert(math.abs(off) < 0.02, s"over $name hop: ${off * 100} %")

object SolverSimulation:
  /** Turns by the number of its decisions, so that its actions show its memory. */
  object Counting extends HeadingPolicy:
    type Memory = Int
    def start: Int                                                  = 0
    def decide(seen: PlanarObservation, memory: Int): (Double, Int) =
      (seen.ownHeadingRad + 0.001 * memory, memory + 1)
