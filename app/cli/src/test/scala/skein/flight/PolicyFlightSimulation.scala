package skein.flight

import skein.loop.{LoopKind, Replay}
import skein.measure.{FlightSummary, Published}
import skein.policy.{LeadPursuit, PolicyFamily, Role}
import skein.report.PaperReport
import skein.report.{Report, ReportSections}
import skein.scenario.Scenarios
import skein.settings.{FlySettings, PolicyFile, RecordedPlan}
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

class PolicyFlightSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = PaperReport.scenarios

  private val policy = PolicyFile(Role.Pursuer, PolicyFamily.leadPursuit, Vector(0.5, 1.25, 1.0))

  private val settings = FlySettings(
    List(LoopKind.Paused, LoopKind.Stream),
    List(LatencyProfile.vpn),
    Span.ofSeconds(12),
    Span.ofMillis(100),
    seed = 3,
    policies = List(policy, policy)
  )

  test(
    "a policy's flights have the delays of the paper's flights; recording, replay and report name the policy"
  ):
    assertEquals(
      settings.plans.map(plan => (plan.id, plan.seed)),
      Vector("", "-lead-pursuit", "-lead-pursuit-2").flatMap(name =>
        Vector(s"paused-none$name" -> 3L, s"stream-vpn$name" -> 3L)
      )
    )
    val flown = settings.plans
      .take(4)
      .map(plan => VirtualFlights.fly(settings, plan).fold(fail(_), identity).recorder.recording)
    val own  = flown(3)
    val read = RecordedPlan.of(own).fold(fail(_), identity)
    assertEquals(read.plan, settings.plans(3))
    assertEquals(
      read.fleet.agents.find(_.role == Role.Pursuer).map(_.policy),
      Some(LeadPursuit(0.5, 1.25, 1.0))
    )
    assertEquals(Replay(read.fleet, own).firstDifference, None)
    assert(Replay(settings.fleet, own).firstDifference.isDefined, "replayed as the paper's pursuer alike")
    assert(own.flight.scenario.contains("lead-pursuit speedRatio=0.5 lead=1.25"), own.flight.scenario)

    val table = ReportSections.text(Report.of(flown))
    assert(table.contains("stream, lead-pursuit"), table)
    // As if the flights were as long as the paper's flights.
    val long = flown.map(FlightSummary.of).map(one =>
      one.copy(flight = one.flight.copy(duration = Published.Duration))
    )
    assertEquals(long.map(_.published.isDefined), Vector(true, true, false, false))
