package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.ExecutionContext
import scala.concurrent.duration.*
import skein.policy.{Policy, KeepHeading}
import skein.record.*
import skein.scenario.PaperDuel
import skein.scenario.Scenarios
import skein.signal.*
import skein.units.*
import skein.vtime.VirtualTime

class DecideWithinSuite extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  private val scenario = PaperDuel().fleet
  private val pursuer  = 1

  /** Decisions and events of five turns by a policy that is late in the third. */
  private def flown(instead: Option[Policy]): (Vector[DecisionRow], Vector[Event]) =
    VirtualTime.run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val recorder           = MemoryRecorder(Samples.heading)
      val world              = FarQuadrotors(scenario, LatencyProfile.none, 1, clock)
      val team               = Team(scenario, world.ports, clock, recorder, LoopSettings())
      val view               = (0 to 1).foldLeft(TeamView.empty(2)): (view, vehicle) =>
        val agent = scenario.agents(vehicle)
        val state = Kinematics(
          agent.startPositionNed + Vector3(0, 3 - vehicle, 0),
          Vector3.Zero,
          Quaternion.Identity,
          Vector3.Zero
        )
        view.withReading(Reading(vehicle, 0, Stamped(state, clock.now(), clock.now(), clock.now())))
      var asked = -1
      Source
        .tick(0.millis, 100.millis, DecisionRequest(view, Set(pursuer)))
        .take(5)
        .via(team.decideWithin(pursuer, Span.ofMillis(40), instead): (memory, seen) =>
          asked += 1
          after(if asked == 2 then 90.millis else 10.millis):
            scala.concurrent.Future.successful(team.decideAt(pursuer, memory, seen._1, seen._2)))
        .runWith(Sink.seq)
        .map: decisions =>
          val recorded = recorder.recording
          assertEquals(recorded.decisions, decisions.toVector.map(Rows(scenario).decision))
          (recorded.decisions, recorded.events)
    .value

  test(
    "a missed deadline is recorded, and the next decision continues from the last one over the elapsed time"
  ):
    val (decisions, events) = flown(instead = None)
    assertEquals(
      events.map(event => (event.kind, event.detail)),
      Vector(EventKind.DeadlineMissed -> "nothing decided: Late")
    )
    assertEquals(decisions.map(_.sequence), Vector(0L, 1L, 2L, 3L))
    assertEquals(decisions.map(_.elapsed.toMillis), Vector(0.0, 100.0, 200.0, 100.0))

  test("if configured, the last decision is repeated, and counts as a decision"):
    val (decisions, events) = flown(instead = Some(KeepHeading))
    assertEquals(events.map(_.kind), Vector(EventKind.DeadlineMissed))
    assertEquals(decisions.map(_.sequence), (0L to 4L).toVector)
    assertEquals(decisions(2).heading.value, decisions(1).heading.value)
    assertNotEquals(decisions(3).heading.value, decisions(2).heading.value)

  test("with a deadline, a loop decides on other threads, and the fallback decides if a policy is late"):
    val run = VirtualTime.run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val recorder           = MemoryRecorder(Samples.heading)
      val world              = FarQuadrotors(scenario, LatencyProfile.direct, 1, clock)
      val settings = LoopSettings(deadline = Some(skein.loop.Deadline(Span.ofMillis(20), Fallback.Hold)))
      val team     = Team(scenario, world.ports, clock, recorder, settings)
      skein.loop.Flight
        .start(LoopKind.Stream, team, Some(world), Span.ofSeconds(2), clock, recorder)
        .outcome
        .map(outcome => (outcome, recorder.recording))
    val (outcome, recording) = run.value
    assertEquals(outcome, FlightOutcome.Completed)
    assert(recording.decisions.size > 30, recording.decisions.size.toString)
    // In virtual time a pure policy takes no time.
    assertEquals(recording.events.filter(_.kind == EventKind.DeadlineMissed), Vector.empty)
    assertEquals(Replay(scenario, recording).firstDifference, None)

  test("a replay uses the fallback for its recorded decisions, and only for these"):
    val (decisions, events) = flown(instead = Some(KeepHeading))
    assertEquals(events.map(_.detail), Vector("decision 2 by the fallback: Late"))
    assertEquals(events.map(_.decision), Vector(Some(2L)))
    val readings  = decisions.flatMap(decision => Seq(decision.own, decision.opponent)).distinct
    val recording = Recording(Samples.heading, readings = readings, decisions = decisions, events = events)
    assertEquals(Replay(scenario, recording).firstDifference, None)
    val reworded = recording.copy(events = events.map(_.copy(detail = "in other words")))
    assertEquals(Replay(scenario, reworded).firstDifference, None)
    val silent = Replay(scenario, recording.copy(events = Vector.empty)).firstDifference
    assertEquals(silent.map(_.column), Some("headingRad"))

  test("a replay uses the fallback that the recording's parameters name"):
    val pursuit             = Fallback.parse("pure-pursuit").fold(fail(_), identity)
    val (decisions, events) = flown(pursuit.policy(scenario.agents(pursuer)))
    val readings            = decisions.flatMap(decision => Seq(decision.own, decision.opponent)).distinct
    def column(parameters: ParameterRow*) =
      val recording = Recording(
        Samples.heading.copy(parameters = parameters),
        readings = readings,
        decisions = decisions,
        events = events
      )
      Replay(scenario, recording).firstDifference.map(_.column)
    val others = Samples.heading.parameters
    assertEquals(column(others :+ ParameterRow(Replay.Fallback, pursuit.label)*), None)
    assertEquals(column(others*), Some("headingRad"))

  test("a fallback is hold, repeat, or a policy for the roles that it supports"):
    assertEquals(Fallback.parse("hold").map(_.policy(scenario.agents(0))), Right(None))
    assertEquals(Fallback.parse("repeat").map(_.policy(scenario.agents(0))), Right(Some(KeepHeading)))
    val pursuit = Fallback.parse("pure-pursuit").fold(fail(_), identity)
    assertEquals(pursuit.label, "pure-pursuit")
    assertEquals(pursuit.policy(scenario.agents(0)), Some(KeepHeading))
    assertNotEquals(pursuit.policy(scenario.agents(pursuer)), Some(KeepHeading))
    assert(Fallback.parse("panic").left.exists(_.startsWith("expected hold, repeat, hover or a policy")))
