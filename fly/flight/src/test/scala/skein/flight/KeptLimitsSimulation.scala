package skein.flight

import skein.loop.{LoopKind, PlanSettings}
import skein.policy.*
import skein.scenario.*
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.Optimised
import skein.units.*

/** A scenario as a user would write it: its policies do not know its limits. */
class KeptLimitsSimulation extends munit.FunSuite, Optimised:
  /** Violations by some vehicles, alone or together with other vehicles. */
  private def violations(scenario: Scenario, loop: LoopKind, by: Int*) =
    val few      = PlanSettings(searches = 1, slices = 4, blocksPerSlice = 2)
    val links    = List(LatencyProfile.vpn)
    val period   = Span.ofMillis(100)
    val settings =
      FlySettings(List(loop), links, scenario.duration, period, seed = 3, scenario, planning = few)
    val flown  = VirtualFlights.result(settings).fold(fail(_), identity)
    val theirs = flown.violations.filter(_.vehicles.exists(by.contains))
    (flown, theirs.map(_.limit.name).distinct.sorted)

  test("plans keep the separation and a fence of any shape, and arrive; policies alone break both limits"):
    val (_, broken) = violations(Couriers(), LoopKind.Predictive, 0, 1)
    assertEquals(broken, Vector("distance outside the geofence", "separation"))
    val (flown, kept) = violations(Couriers(), LoopKind.Plan, 0, 1)
    assertEquals(kept, Vector.empty)
    assert(flown.value("furthest from the goals").exists(_ < 6), flown.measured.toString)

  test("a planning pursuer keeps the scenario's separation from its opponent, too, in a round fence"):
    val (_, broken) = violations(Shadow(), LoopKind.Predictive, 1)
    assertEquals(broken, Vector("distance from the geofence's middle", "separation"))
    assertEquals(violations(Shadow(), LoopKind.Plan, 1)._2, Vector.empty)

  test(
    "plans climb or sink to between floor and ceiling, and stay below the speed limit"
  ):
    for corridor <- Seq(Corridor(7, 12), Corridor(1, 3.8)) do
      val (_, broken) = violations(corridor, LoopKind.Predictive, 0, 1)
      assertEquals(broken, Vector("altitude", "speed"))
      val (flown, _) = violations(corridor, LoopKind.Plan, 0, 1)
      val late       = flown.violations.filter(violation => violation.toS > Corridor.ClimbS)
      assertEquals(late.map(one => (one.limit.text, one.worst, one.toS)), Vector.empty, corridor)
      assert(flown.value("furthest from the goals").exists(_ < 6), flown.measured.toString)

/** A corridor whose vehicles start at 5 m, below the floor, and whose policies choose 5 m/s, above the speed
  * limit.
  */
final case class Corridor(floorM: Double, ceilingM: Double) extends Scenario:
  def agents: Vector[Agent]              = Couriers().agents
  override def duration: Span            = Span.ofSeconds(14)
  override def measures: Vector[Measure] = Couriers().measures
  override def limits: Vector[Limit]     = Vector(
    Limit.floor(Metres(floorM)),
    Limit.ceiling(Metres(ceilingM)),
    Limit.speed(MetresPerSecond(4))
  )

object Corridor:
  /** Time until which vehicles may still climb or descend. */
  val ClimbS = 5.0

/** Two vehicles fly at one another, each to the other's start, past a notch in the field's edge. */
final case class Couriers() extends Scenario:
  private val goals = Vector((18.0, 3.0), (-18.0, 3.0))

  def agents: Vector[Agent] = goals.zipWithIndex.map: (goal, place) =>
    val start = Vector3(-goal._1, goal._2, -5)
    Agent(
      s"Courier$place",
      Role("Courier"),
      MetresPerSecond(5),
      start,
      Radians(place * math.Pi),
      ToGoal(goal)
    )

  override def duration: Span = Span.ofSeconds(14)

  override def limits: Vector[Limit] = Vector(
    Limit.separation(Metres(4)),
    Limit.geofence(
      Vector((-40, -25), (40, -25), (40, 15), (8, 15), (0, 1), (-8, 15), (-40, 15)).map((north, east) =>
        (Metres(north), Metres(east))
      )
    )
  )

  override def measures: Vector[Measure] = Vector(Measure("furthest from the goals", "m")(tracks =>
    Some(tracks.vehicles.map(one =>
      tracks.distanceM(one, goals(one)._1, goals(one)._2, tracks.instants.last)
    ).max)
  ))

/** Flies straight to a place, which is its goal. */
final case class ToGoal(goal: (Double, Double)) extends Policy, Goal:
  def mostMps: Double = 6

  private def way(seen: Observation) =
    (goal._1 - seen.northM(seen.self), goal._2 - seen.eastM(seen.self))

  def wanted(seen: Observation, aheadS: Double): (Double, Double) =
    val (north, east) = way(seen)
    val share         = (5 * aheadS / math.hypot(north, east).max(1e-9)).min(1)
    (seen.northM(seen.self) + north * share, seen.eastM(seen.self) + east * share)

  type Memory = Unit
  def start: Unit                                             = ()
  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    val (north, east) = way(seen)
    (seen.towards(north, east, mostMps = 5), ())

/** The paper's two vehicles, which must keep apart, in a round field; the evader, which does not plan, may
  * leave it.
  */
final case class Shadow() extends Scenario:
  def agents: Vector[Agent]          = PaperDuel().agents
  override def duration: Span        = Span.ofSeconds(12)
  override def limits: Vector[Limit] =
    Vector(Limit.separation(Metres(7)), Limit.geofence(Metres(0), Metres(0), Metres(20)))
