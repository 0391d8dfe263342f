package skein.flight

import skein.loop.{LoopKind, Outcome}
import skein.settings.{FlySettings, Wire}
import skein.signal.LatencyProfile
import skein.units.*

/** The duel over MAVLink, in virtual time, beside the same one over AirSim's wire. */
class MavlinkFlightSimulation extends munit.FunSuite:
  private def flown(wire: Wire, link: String): VirtualFlightResult =
    val settings = FlySettings(
      List(LoopKind.Stream),
      List(LatencyProfile.parse(link, Left(_)).toOption.get),
      Span.ofSeconds(20),
      Span.ofMillis(100),
      seed = 1,
      wire = wire
    )
    VirtualFlights.fly(settings, settings.plans.head).fold(fail(_), identity)

  for link <- Seq("direct", "vpn") do
    val over = flown(Wire.Mavlink, link)

    test(s"over $link, it is flown to its end"):
      assertEquals(over.landed.outcome, Outcome.Completed)
      assert(over.recorder.recording.decisions.size >= 320, s"${over.recorder.recording.decisions.size}")

    test(s"over $link, ages are true within 10 ms, and from their tenth second on within 5"):
      // The vehicles' clock began with the flight's.
      val began     = over.recorder.recording.heading.flight.startedAt
      val decisions = over.recorder.recording.decisions
      val errors    =
        for
          decision <- decisions
          told     <- decision.trueAge
          truth = decision.decidedAt.since(began + decision.own.state.validAt.since(Instant.Epoch))
        yield (
          late = decision.decidedAt.since(decisions.head.decidedAt).toSeconds >= 10,
          ms = (told.own - truth).toMillis.abs
        )
      assert(errors.count(_.late) > 150, s"${errors.count(_.late)}")
      for (late, ms) <- errors do assert(ms < (if late then 5 else 10), s"late: $late, $ms ms")

  test("the same seed gives the same flight"):
    val ends = Vector.fill(2)(flown(Wire.Mavlink, "vpn").recorder.recording.decisions.last.own.state.value)
    assertEquals(ends(0), ends(1))

  test("paused is refused"):
    val settings = FlySettings(
      List(LoopKind.Paused),
      List(LatencyProfile.none),
      Span.ofSeconds(5),
      Span.ofMillis(100),
      seed = 1,
      wire = Wire.Mavlink
    )
    assert(VirtualFlights.fly(settings, settings.plans.head).left.exists(_.contains("MAVLink")))
