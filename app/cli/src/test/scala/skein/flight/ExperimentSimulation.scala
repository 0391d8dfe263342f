package skein.flight

import skein.loop.{LoopKind, FlightOutcome}
import skein.measure.{DistanceCurve, FlightSummary}
import skein.record.{EventKind, Recording}
import skein.report.PaperReport
import skein.scenario.{PaperDuel, Scenarios}
import skein.settings.{FlightPlan, FlySettings}
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** The paper's experiment in virtual time, compared with the results of AirSim's own flight code. */
class ExperimentSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = PaperReport.scenarios

  private def fly(
      loop: LoopKind,
      link: LatencyProfile,
      asPublished: Boolean = false,
      pairs: Int = 1,
      seconds: Double = 60
  ): Recording =
    val settings =
      FlySettings(
        List(loop),
        List(link),
        Span.ofSeconds(seconds),
        Span.ofMillis(100),
        1,
        PaperDuel(pairs, asPublished)
      )
    val flown =
      VirtualFlights.fly(settings, FlightPlan(loop.label, loop, link, seed = 1)).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    flown.recorder.recording

  private def distance(
      loop: LoopKind,
      link: LatencyProfile,
      asPublished: Boolean = false
  ): DistanceCurve = FlightSummary.of(fly(loop, link, asPublished)).distance.get

  private lazy val truth = distance(LoopKind.Paused, LatencyProfile.none)

  private def within(value: Double, least: Double, most: Double): Unit =
    assert(value >= least && value <= most, s"expected $least to $most, got $value")

  test("the paused flight converges to 8.31 m after a closest approach of 3.7 m at 6 s"):
    within(truth.lastTenSeconds.get.mean, 8.31 * 0.97, 8.31 * 1.03)
    within(truth.closest._1, 5.7, 6.3)
    within(truth.closest._2, 3.4, 4.0)

  for loop <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive) do
    test(s"without a network, ${loop.label} is within 2 % of the paused flight"):
      val ratio = distance(loop, LatencyProfile.none).lastTenSeconds.get.mean / truth.lastTenSeconds.get.mean
      within(ratio, 0.98, 1.02)

  test("over the direct link, futures and stream orbit steadily where AirSim's own flight code does"):
    val futures = distance(LoopKind.Futures, LatencyProfile.direct).lastTenSeconds.get
    within(futures.mean, 9.0, 9.7)
    val stream = distance(LoopKind.Stream, LatencyProfile.direct).lastTenSeconds.get
    within(stream.mean, 8.9, 9.6)
    within(stream.sd, 0, 0.3)

  test("over the busy VPN, stream orbits steadily"):
    val stream = distance(LoopKind.Stream, LatencyProfile.vpn).lastTenSeconds.get
    // AirSim's flights gave 9.9 to 10.6 m; never having a third move outstanding costs the rest.
    within(stream.mean, 9.9, 11.0)
    within(stream.sd, 0, 0.3)

  test("over the busy VPN, predictive keeps the distance of the paused flight within 4 %"):
    val ratio =
      distance(
        LoopKind.Predictive,
        LatencyProfile.vpn
      ).lastTenSeconds.get.mean / truth.lastTenSeconds.get.mean
    within(ratio, 0.96, 1.04)

  test("as published, sequential oscillates, since the pursuer's turn grows with the time between decisions"):
    val curve    = distance(LoopKind.Sequential, LatencyProfile.vpn, asPublished = true)
    val settling = curve.points.collect { case (seconds, metres) if seconds > 10 => metres }
    within(settling.min, 0, 8)
    within(settling.max, 35, 60)

  test("twenty vehicles over the busy VPN decide ten times per second each, without a lost or refused call"):
    val recording = fly(LoopKind.Stream, LatencyProfile.vpn, pairs = 10, seconds = 20)
    val decisions = recording.decisions.groupBy(_.vehicle).view.mapValues(_.size).toMap
    assertEquals(decisions.size, 20)
    decisions.values.foreach(count => within(count, 160, 200))
    val unwanted = recording.events.filter(_.kind != EventKind.Dropped)
    assert(unwanted.isEmpty, unwanted.take(5).mkString("\n"))
    assertEquals(recording.acknowledgements.size, recording.commands.size)
