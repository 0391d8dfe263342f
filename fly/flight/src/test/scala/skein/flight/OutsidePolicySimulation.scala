package skein.flight

import scala.util.Using
import skein.loop.{Fallback, LoopKind, FlightOutcome}
import skein.policy.PolicyFamily
import skein.record.{EventKind, Recording}
import skein.settings.{FlySettings, OutsidePolicy, Peer}
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** Flights in virtual time with a policy behind a socket. */
class OutsidePolicySimulation extends munit.FunSuite, Unhurried:
  private val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(4),
    period = Span.ofMillis(100),
    seed = 7,
    fallback = Fallback.Decides(PolicyFamily.paperPursuer)
  )

  private val Pursuer = "Pursuer"

  private def timely = settings.copy(deadline = Some(Span.ofMillis(20)))

  /** The last flight of the settings: by the policy behind the socket, if there is one. */
  private def flown(settings: FlySettings): (FlightOutcome, Recording) =
    val landing = VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)
    (landing.landed.outcome, landing.recorder.recording)

  private def flownBy(settings: FlySettings, within: Span = OutsidePolicy.AnswerWithin)(
      answer: (Int, Vector[Float]) => Option[Array[Byte]]
  ): (FlightOutcome, Recording) =
    Using.resource(Peer(answer)): peer =>
      flown(settings.copy(policies = OutsidePolicy.reach(peer.option, within).toOption.toList))

  private def headings(recording: Recording) =
    recording.decisions.map(decision => (decision.vehicle, decision.decidedAt, decision.heading.value))

  private def missed(recording: Recording) =
    recording.events.filter(_.kind == EventKind.DeadlineMissed)

  test("an outside policy flies as an equal policy in this process does, with a deadline and without"):
    val (outcome, own) = flown(settings)
    assertEquals(outcome, FlightOutcome.Completed)
    assert(own.decisions.size > 60, own.decisions.size)
    for asked <- Seq(settings, timely) do
      val (outcome, outside) = flownBy(asked)((_, seen) => Some(Peer.pursuer(seen)))
      assertEquals(outcome, FlightOutcome.Completed)
      assertEquals(missed(outside), Vector.empty)
      assertEquals(headings(outside), headings(own))

  test("if the external policy fails, the fallback decides, and each recorded event states the reason"):
    val (outcome, recording) = flownBy(timely): (number, seen) =>
      Some(if number % 2 == 0 then Peer.refusal("no such luck") else Peer.pursuer(seen))
    assertEquals(outcome, FlightOutcome.Completed)
    val decided = recording.decisions.filter(_.vehicle == Pursuer)
    assertEquals(missed(recording).flatMap(_.decision), decided.map(_.sequence).filter(_ % 2 == 0))
    assert(missed(
      recording
    ).forall(_.detail.contains("by the fallback: Failed(the policy: no such luck)")))
    assertEquals(headings(recording), headings(flown(settings)._2))

  test("if the outside policy hangs, the fallback decides from then on"):
    val (outcome, recording) = flownBy(timely, within = Span.ofMillis(200)): (number, seen) =>
      Some(if number < 10 then Peer.pursuer(seen) else Array.empty)
    assertEquals(outcome, FlightOutcome.Completed)
    val decided = recording.decisions.filter(_.vehicle == Pursuer)
    assert(decided.size > 30, decided.size)
    assertEquals(missed(recording).size, decided.size - 10)
    assert(missed(recording).forall(_.detail.contains("expected an answer within 200 ms, got none")))

  test("without a deadline, an outside policy that fails ends the flight with its error message"):
    flownBy(settings)((number, seen) =>
      Some(if number < 5 then Peer.pursuer(seen) else Peer.refusal("no such luck"))
    ) match
      case (FlightOutcome.Failed(reason), _) => assert(reason.contains("the policy: no such luck"), reason)
      case (other, _)                        => fail(s"$other")

  test("warm-up flights in virtual time do not call the outside policy"):
    Using.resource(Peer((_, _) => None)): peer =>
      val outside = settings.copy(policies = OutsidePolicy.reach(peer.option).toOption.toList)
      assertEquals(WarmUp.fly(outside, 2, Clock.ofNanos(() => 0)), Right(2))
      assertEquals(peer.asked, 0)
