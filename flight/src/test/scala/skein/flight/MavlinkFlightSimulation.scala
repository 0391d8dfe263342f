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

    test(s"over $link, ages are true within 5 ms at 19 of 20 decisions, and within 10 always"):
      // The vehicles' clock began with the flight's.
      val began  = over.recorder.recording.heading.flight.startedAt
      val errors =
        for
          decision <- over.recorder.recording.decisions
          told     <- decision.trueAge
          truth = decision.decidedAt.since(began + decision.own.state.validAt.since(Instant.Epoch))
        yield (told.own - truth).toMillis.abs
      val sorted = errors.sorted
      assert(errors.size > 300, s"${errors.size}")
      assert(
        sorted(sorted.size * 19 / 20) < 5 && sorted.last < 10,
        s"${sorted(sorted.size * 19 / 20)}, ${sorted.last} ms"
      )

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
