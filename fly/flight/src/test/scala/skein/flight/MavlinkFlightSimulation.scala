package skein.flight

import skein.loop.{LoopKind, FlightOutcome, PlanSettings}
import skein.scenario.Scenarios
import skein.settings.{FlySettings, Wire}
import skein.signal.LatencyProfile
import skein.testing.{Optimised, TemporaryFolders}
import skein.units.*

/** The duel over MAVLink, in virtual time, compared with that over AirSim's wire protocol. */
class MavlinkFlightSimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

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

    test(s"over $link, the flight completes"):
      assertEquals(over.landed.outcome, FlightOutcome.Completed)
      assert(over.recorder.recording.decisions.size >= 320, s"${over.recorder.recording.decisions.size}")

    test(s"over $link, ages are correct within 5 ms, from the first decision on"):
      // The vehicles' clock started when the flight's clock started.
      val began     = over.recorder.recording.heading.flight.startedAt
      val decisions = over.recorder.recording.decisions
      val errors    =
        for
          decision <- decisions
          told     <- decision.trueAge
          truth = decision.decidedAt.since(began + decision.own.state.validAt.since(Instant.Epoch))
        yield (told.own - truth).toMillis.abs
      assert(errors.size > 300, s"${errors.size}")
      assert(errors.max < 5, s"${errors.max} ms, ${errors.count(_ >= 5)} of ${errors.size}")

  test("equal seeds give equal flights"):
    val ends = Vector.fill(2)(flown(Wire.Mavlink, "vpn").recorder.recording.decisions.last.own.state.value)
    assertEquals(ends(0), ends(1))

  private def brief(loop: LoopKind) = FlySettings(
    List(loop),
    List(LatencyProfile.vpn),
    Span.ofSeconds(3),
    Span.ofMillis(100),
    seed = 1,
    planning = PlanSettings(horizonSteps = 10, slices = 2, blocksPerSlice = 1),
    wire = Wire.Mavlink
  )

  for loop <- LoopKind.values if loop != LoopKind.Paused do
    folder.test(s"${loop.label} flies over MAVLink, and its recording replays to equal decisions"): folder =>
      val settings = brief(loop)
      val plan     = settings.plans.last
      val flown    = VirtualFlights.fly(settings, plan).fold(fail(_), identity)
      assertEquals(flown.landed.outcome, FlightOutcome.Completed)
      val recording = flown.recorder.recording
      for agent <- settings.fleet.agents do
        val commands = recording.commands.count(_.vehicle == agent.name)
        assert(commands > 10, s"$commands commands to ${agent.name}")
      val file = plan.file(folder)
      assert(flown.recorder.writeTo(file).isRight)
      val replayed = Replayed.of(file).fold(fail(_), identity)
      assert(replayed.isSame && replayed.decisions > 20, s"$replayed")

  test("paused is refused"):
    val settings = brief(LoopKind.Paused)
    assert(VirtualFlights.fly(settings, settings.plans.head).left.exists(_.contains("MAVLink")))
