package skein.loop

import skein.planning.{Separation, Target}
import skein.policy.{AgentPolicy, Course, Fleet, GoalPolicy, KeepHeading, Policy, Role, TeamObservation}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** What a pursuer plans upon: its own limits, what it keeps from whom, and how far it may turn at once. */
class PlanningSuite extends munit.FunSuite:
  private val fleet   = PaperDuel(pairs = 2).fleet
  private val pursuer = fleet.agents.indexWhere(_.role == Role.Pursuer)
  private val now     = Instant.Epoch + Span.ofSeconds(50)
  private val places  = fleet.agents.indices.map(vehicle => Vector3(10.0 * vehicle, -vehicle.toDouble, -20))
  private val view    = fleet.agents.indices.foldLeft(TeamView.empty(fleet.agents.size)): (view, vehicle) =>
    val state = Kinematics(places(vehicle), Vector3(1, 2, 0), Quaternion.Identity, Vector3.Zero)
    view.withReading(Reading(vehicle, 0, Stamped(state, now, now, now)))

  private def part(settings: PlanSettings, decidedBefore: Option[Span] = None) =
    PursuitPlanning(fleet, pursuer, settings, seed = 3)
      .pose(Memory(0.25, decidedBefore.map(now - _), 7), view, now)

  test(
    "vehicles that are neither planned nor the opponent are kept from where a separation is set, with a metre more"
  ):
    val apart = part(PlanSettings(separationM = 5))
    assertEquals(apart.objective.separation, Separation(5, margin = 1))
    assertEquals(apart.situation.others.size, 1) // the other pair's evader
    assert(PursuitPlanning(fleet, pursuer, PlanSettings(separationM = 5), 3).regardsTeam)
    val alone = part(PlanSettings())
    assertEquals(alone.objective.separation, Separation(0, margin = 0))
    assertEquals(alone.situation.others.size, 0)
    assert(!PursuitPlanning(fleet, pursuer, PlanSettings(), 3).regardsTeam)

  test("it may turn for as long as it has not decided, at most for half a second"):
    assertEquals(part(PlanSettings()).situation.sinceDecisionS, 0.0)
    assertEquals(part(PlanSettings(), Some(Span.ofMillis(200))).situation.sinceDecisionS, 0.2)
    assertEquals(part(PlanSettings(), Some(Span.ofSeconds(3))).situation.sinceDecisionS, 0.5)

  test("its turn rate is its speed over its turning radius, its least speed a share of the one it commands"):
    val limits = part(PlanSettings(turningRadiusM = 4, slowestShare = 0.5)).objective.limits
    val speed  = fleet.agents(pursuer).speed.value
    assertEquals((limits.minSpeed, limits.maxSpeed), (speed / 2, speed))
    assertEqualsDouble(limits.turnRateAt(speed), speed / 4, 1e-12)

  test(
    "the opponent is taken to fly by the policy that the scenario states, from the heading it was sent last"
  ):
    val evader                       = fleet.opponentOf(pursuer, places)
    def flownBy(policy: AgentPolicy) =
      Fleet(fleet.agents.updated(evader, fleet.agents(evader).copy(policy = policy)))
    def target(policy: AgentPolicy) =
      val posed = PursuitPlanning(flownBy(policy), pursuer, PlanSettings(behaviours = 1), 3)
        .pose(Memory(0.25, None, 7), view.withMove(Move(evader, 1, 0.7, now)), now)
      posed.situation.behaviours.head.target
    target(KeepHeading) match
      case opponent: Target.Opponent =>
        assertEquals((opponent.policy, opponent.headingRad), (KeepHeading, 0.7))
        assertEquals(opponent.speed, fleet.agents(evader).speed.value)
      case other => fail(s"came $other")
    assertEquals(OpponentModel.missing(flownBy(KeepHeading)), Vector.empty)

    object Lucky extends Policy:
      def heading(dx: Double, dy: Double, dvx: Double, dvy: Double, own: Double, its: Double, s: Double) =
        System.nanoTime.toDouble
    assert(target(Lucky).isInstanceOf[Target.Along])
    val told = OpponentModel.missing(flownBy(Lucky))
    assert(
      told.exists(_.startsWith(s"plan: ${fleet.agents(evader).name} is taken to fly straight on: ")),
      told
    )

  test("each vehicle's each plan has random numbers of its own"):
    val streams =
      for seed <- 1L to 5L; self <- 0 until 5; decisions <- 0L until 20L
      yield Planning.stream(seed, self, Memory(0, None, decisions))
    assertEquals(streams.distinct.size, streams.size)

  /** A slot that moves north at 3 m/s, whatever is seen. */
  private final class Moving(override val minimumM: Double = 0) extends GoalPolicy:
    def mostMps: Double                                                 = 6
    def wanted(seen: TeamObservation, aheadS: Double): (Double, Double) = (3 * aheadS, 4)
    def course(seen: TeamObservation): Course                           = Course(0, 3)

  private def teamPart(policy: Moving, settings: PlanSettings, decidedBefore: Option[Span] = None) =
    val team = Fleet(fleet.agents.map(_.copy(policy = policy)))
    TeamPlanning(team, pursuer, policy, settings, seed = 3)
      .pose(Memory(0.25, decidedBefore.map(now - _), 7), view, now)

  test("one of a team cruises as fast as the place moves where its policy wants to be"):
    for steps <- Seq(2, 10) do
      val posed = teamPart(Moving(), PlanSettings(horizonSteps = steps, step = Span.ofMillis(200)))
      assertEqualsDouble(posed.objective.cruiseSpeed, 3, 1e-12)
      // It may stand still.
      assertEquals((posed.objective.limits.minSpeed, posed.objective.limits.maxSpeed), (0.0, 6.0))
    // One place does not move.
    assertEquals(teamPart(Moving(), PlanSettings(horizonSteps = 1)).objective.cruiseSpeed, 0.0)

  test(
    "it keeps the widest separation that anybody set, and a metre more, and is suggested no policy that avoids"
  ):
    def separation(policy: Moving, settings: PlanSettings) =
      val posed = teamPart(policy, settings)
      (posed.objective.separation.minimum, posed.situation.suggested.size)
    assertEquals(separation(Moving(), PlanSettings()), (0.0, 1))
    assertEquals(separation(Moving(2), PlanSettings()), (3.0, 0))
    assertEquals(separation(Moving(2), PlanSettings(separationM = 5)), (6.0, 0))
    val kept = PlanSettings(separationM = 5, kept = Vector(skein.scenario.Kept.Apart(7)))
    assertEquals(separation(Moving(), kept), (8.0, 1))

  test("after a longer pause one of a team turns no further at once, a radian"):
    def mostAtOnce(pauseS: Double) =
      teamPart(
        Moving(),
        PlanSettings(step = Span.ofMillis(100)),
        Some(Span.ofSeconds(pauseS))
      ).objective.limits.maxTurnRate
    assertEquals(mostAtOnce(0.05), 1 / 0.1)
    assertEquals(mostAtOnce(0.4), 1 / 0.4)
