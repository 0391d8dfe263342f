package skein.flight

import skein.loop.LoopKind
import skein.policy.*
import skein.scenario.Scenario
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** The fate of a plan if a policy cannot state its goal. */
class BrokenGoalSimulation extends munit.FunSuite, Unhurried:

  private final case class Wanting(place: () => (Double, Double)) extends Policy, Goal:
    type Memory = Unit
    def start: Unit                                                 = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit)     = (seen.along(0, 1), ())
    def mostMps: Double                                             = 5
    def wanted(seen: Observation, aheadS: Double): (Double, Double) = place()

  private final case class Errand(place: () => (Double, Double)) extends Scenario:
    def agents: Vector[Agent] = Vector(
      Agent("Lone", Role("Scout"), MetresPerSecond(5), Vector3(0, 0, -10), Radians(0), Wanting(place))
    )

  private def reason(place: => (Double, Double)): String =
    VirtualFlights
      .result(Errand(() => place), LoopKind.Plan, LatencyProfile.none, seed = 1, duration = Span.ofSeconds(1))
      .fold(identity, _ => fail("it was flown"))

  test("a goal that is not finite, or an exception in it, ends the flight with the vehicle's name"):
    assert(clue(reason((
      Double.NaN,
      0
    ))).contains("the policy of Lone decided for what no vehicle can do: (NaN,0.0)"))
    assert(clue(
      reason(sys.error("no idea"))
    ).contains("the policy of Lone failed: java.lang.RuntimeException: no idea"))
