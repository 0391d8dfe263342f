package skein.loop

import skein.planning.{JointPlanner, Manoeuvre, ManoeuvreRollout, PlanProblem, SeparationCost, Target}
import skein.policy.{
  Action,
  Fleet,
  Goal,
  HeadingPolicy,
  KeepHeading,
  Observation,
  PlanarObservation,
  Policy,
  Role
}
import skein.scenario.{Kept, PaperDuel}
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vehicle.QuadrotorModel

/** The input of a pursuer's plan: its own limits, the separation it keeps, and its largest first turn. */
class PlanningSuite extends munit.FunSuite:
  private val fleet   = PaperDuel(pairs = 2).fleet
  private val pursuer = fleet.agents.indexWhere(_.role == Role.Pursuer)
  private val now     = Instant.Epoch + Span.ofSeconds(50)
  private val places  = fleet.agents.indices.map(vehicle => Vector3(10.0 * vehicle, -vehicle.toDouble, -20))
  private val view    = fleet.agents.indices.foldLeft(TeamView.empty(fleet.agents.size)): (view, vehicle) =>
    val state = Kinematics(places(vehicle), Vector3(1, 2, 0), Quaternion.Identity, Vector3.Zero)
    view.withReading(Reading(vehicle, 0, Stamped(state, now, now, now)))

  private def foreseen(fleet: Fleet) = fleet.agents.indices
    .map: vehicle =>
      val known = ForeseenVehicle.of(fleet.agents(vehicle), QuadrotorModel.AirSim, PlanSettings())
      vehicle -> known.fold(fail(_), identity)
    .toMap

  private def pursuit(settings: PlanSettings, fleet: Fleet = fleet) =
    PursuitPlanning(fleet, pursuer, foreseen(fleet), settings, seed = 3)

  private def teamwork(fleet: Fleet, goal: Goal, settings: PlanSettings) =
    TeamPlanning(fleet, pursuer, goal, foreseen(fleet)(pursuer), settings, seed = 3)

  private def jointly(fleet: Fleet, settings: PlanSettings) =
    JointPlanning.of(fleet, LoopSettings(planning = settings, seed = 3)).fold(fail(_), identity)

  private def part(settings: PlanSettings, decidedBefore: Option[Span] = None) =
    pursuit(settings)
      .pose(Memory(0.25, decidedBefore.map(now - _), 7), view, now)

  test(
    "with a configured separation, vehicles outside a duel are avoided, with a margin of a metre"
  ):
    val apart = part(PlanSettings(separationM = 5))
    assertEquals(apart.objective.separation, SeparationCost(5, margin = 1))
    assertEquals(apart.situation.others.size, 1) // the other pair's evader
    assert(pursuit(PlanSettings(separationM = 5)).regardsTeam)
    val alone = part(PlanSettings())
    assertEquals(alone.objective.separation, SeparationCost(0, margin = 0))
    assertEquals(alone.situation.others.size, 0)
    assert(!pursuit(PlanSettings()).regardsTeam)

  test(
    "the scenario's separation applies to opponents, too, with a margin of a metre, however small it is"
  ):
    val settings = PlanSettings(separationM = 5, kept = Vector(skein.scenario.Kept.Apart(7)))
    val kept     = part(settings)
    assertEquals(kept.objective.separation, SeparationCost(8, margin = 1, doubt = 1))
    assertEquals(kept.situation.others.size, 2) // both evaders
    val least = PlanSettings(kept = Vector(skein.scenario.Kept.Apart(0.5)))
    assertEquals(part(least).objective.separation, SeparationCost(1.5, margin = 1, doubt = 1))
    assertEquals(part(least).situation.others.size, 2)
    val little = PlanSettings(separationM = 0.5)
    assertEquals(part(little).objective.separation, SeparationCost(0.5, margin = 1))
    assert(pursuit(little).regardsTeam)

  /** The decision instead of a plan by a policy that turns by this angle from its last heading, 0.25 rad. */
  private def byPolicy(turn: Double, settings: PlanSettings): (Decision, PlannedDecision) =
    object Turning extends HeadingPolicy.Memoryless:
      def heading(seen: PlanarObservation): Double = seen.ownHeadingRad + turn
    val turning  = Fleet(fleet.agents.updated(pursuer, fleet.agents(pursuer).copy(policy = Turning)))
    val planning = pursuit(settings, turning)
    decidedBy(planning, isOld = true)

  private def decidedBy(planning: Planning, isOld: Boolean): (Decision, PlannedDecision) =
    val memory    = Memory(0.25, Some(now - Span.ofMillis(200)), 7)
    val posed     = planning.pose(memory, view, now)
    val plan      = JointPlanner().resumed(PlanProblem(planning.planner, Vector(posed)), None).plans.head
    val (_, made) = planning.decide(memory, view, now, posed, plan, Vector.empty, isOld)
    (made.decision, made)

  test(
    "if its policy decides instead of a plan, a pursuer keeps its turn limit and its constant speed"
  ):
    // 10 m/s over 8 m for 0.2 s are 0.25 rad.
    assertEquals(fleet.agents(pursuer).speed.value, 10.0)
    for (turn, heading) <- Seq(2.0 -> 0.5, -2.0 -> 0.0, 0.125 -> 0.375, -0.125 -> 0.125) do
      val (decision, made) = byPolicy(turn, PlanSettings())
      assertEqualsDouble(decision.heading.value, heading, 1e-9)
      assertEquals((decision.action.speed, made.plan.byPolicy), (fleet.agents(pursuer).speed, true))

  test("a plan chooses the speed if the limit is below the vehicle's own"):
    val slower = PlanSettings(kept = Vector(Kept.NoFaster(5)))
    assertEquals(byPolicy(0.1, slower)._1.action.speed.value, slower.speedMps(10))
    assertEquals(decidedBy(pursuit(PlanSettings()), isOld = false)._1.action.speed.value, 10.0)

  test("a pursuer may turn for the time since its last decision, at most for half a second"):
    assertEquals(part(PlanSettings()).situation.firstTurnS, 0.0)
    assertEquals(part(PlanSettings(), Some(Span.ofMillis(200))).situation.firstTurnS, 0.2)
    val pause = part(PlanSettings(), Some(Span.ofSeconds(3))).situation
    assertEquals((pause.firstTurnS, pause.sinceDecisionS), (0.5, 3.0))

  test("the maximum turn rate is speed over turning radius; the minimum speed is a fraction of the maximum"):
    val limits = part(PlanSettings(turningRadiusM = 4, slowestShare = 0.5)).objective.limits
    val speed  = fleet.agents(pursuer).speed.value
    assertEquals((limits.minSpeed, limits.maxSpeed), (speed / 2, speed))
    assertEqualsDouble(limits.turnRateAt(speed), speed / 4, 1e-12)

  test(
    "the opponent is predicted by the scenario's policy, from the heading last sent to it"
  ):
    val evader                  = fleet.opponentOf(pursuer, places)
    def flownBy(policy: Policy) =
      Fleet(fleet.agents.updated(evader, fleet.agents(evader).copy(policy = policy)))
    def target(policy: Policy) =
      val posed = pursuit(PlanSettings(behaviours = 1), flownBy(policy))
        .pose(
          Memory(0.25, None, 7),
          view.withMove(SentCommand(evader, 1, Radians(0.7), now, Action.Hover)),
          now
        )
      posed.situation.behaviours.head.target
    target(KeepHeading) match
      case opponent: Target.Opponent =>
        assertEquals((opponent.policy, opponent.headingRad), (KeepHeading, 0.7))
        assertEquals(opponent.speed, fleet.agents(evader).speed.value)
      case other => fail(s"got $other")
    assertEquals(OpponentModel.missing(flownBy(KeepHeading)), Vector.empty)

    object Lucky extends HeadingPolicy.Memoryless:
      def heading(seen: PlanarObservation): Double = System.nanoTime.toDouble
    assert(target(Lucky).isInstanceOf[Target.Along])
    // Only of vehicles that are opponents in a plan.
    def all(policy: Policy) = Fleet(fleet.agents.map(_.copy(policy = policy)))
    val luckyPursuers       = Fleet(fleet.agents.map(agent =>
      if agent.role == Role.Pursuer then agent.copy(policy = Lucky) else agent.copy(policy = KeepHeading)
    ))
    assertEquals(OpponentModel.missing(luckyPursuers), Vector.empty)
    assertEquals(OpponentModel.missing(all(Moving())), Vector.empty)
    val told = OpponentModel.missing(flownBy(Lucky))
    assert(
      told.exists(_.startsWith(s"plan: ${fleet.agents(evader).name} is taken to fly straight on: ")),
      told
    )

  test("the user reads which opponents' memories plans do not know"):
    object Turning extends HeadingPolicy:
      type Memory = Double
      def start: Double                                                     = 0
      def decide(seen: PlanarObservation, memory: Double): (Double, Double) =
        (seen.ownHeadingRad + memory, memory + 0.01 * seen.elapsedS)
    val evader  = fleet.opponentOf(pursuer, places)
    val turning = Fleet(fleet.agents.updated(evader, fleet.agents(evader).copy(policy = Turning)))
    assertEquals(
      OpponentModel.missing(turning),
      Vector(
        s"plan: ${fleet.agents(evader).name} is predicted as if it had just begun: " +
          "plans do not know its policy's memory"
      )
    )

  test("each plan of each vehicle has its own random numbers"):
    val streams =
      for seed <- 1L to 5L; self <- 0 until 5; decisions <- 0L until 20L
      yield Planning.stream(seed, self, Memory(0, None, decisions))
    assertEquals(streams.distinct.size, streams.size)

  /** A slot that moves north at 3 m/s, whatever the observation. */
  private final class Moving(override val minimumM: Double = 0) extends Policy, Goal:
    def mostMps: Double                                             = 6
    def wanted(seen: Observation, aheadS: Double): (Double, Double) = (3 * aheadS, 4)
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) = (seen.along(0, 3), ())

  private def teamPart(policy: Moving, settings: PlanSettings, decidedBefore: Option[Span] = None) =
    val team = Fleet(fleet.agents.map(_.copy(policy = policy)))
    teamwork(team, policy, settings)
      .pose(Memory(0.25, decidedBefore.map(now - _), 7), view, now)

  test("a team's vehicle cruises at the speed of the point at which its policy wants to be"):
    for steps <- Seq(2, 10) do
      val posed = teamPart(Moving(), PlanSettings(horizonSteps = steps, step = Span.ofMillis(200)))
      assertEqualsDouble(posed.objective.cruiseSpeed, 3, 1e-12)
      // It is to be on its place at the end of each step.
      posed.situation.behaviours.map(_.target) match
        case Vector(Target.Along(track)) =>
          assertEqualsDouble(track.x(0), 0.6, 1e-6)
          assertEqualsDouble(track.x(steps - 1), 0.6 * steps, 1e-5)
          assertEquals(track.y(0), 4.0)
        case other => fail(s"got $other")
      // It may stand still.
      assertEquals((posed.objective.limits.minSpeed, posed.objective.limits.maxSpeed), (0.0, 6.0))
    // One place does not move.
    assertEquals(teamPart(Moving(), PlanSettings(horizonSteps = 1)).objective.cruiseSpeed, 0.0)

  test(
    "a team's plan keeps a metre more than the widest separation; no policy that avoids is suggested"
  ):
    def separation(policy: Moving, settings: PlanSettings) =
      val posed = teamPart(policy, settings)
      (posed.objective.separation.minimum, posed.situation.suggested.size)
    assertEquals(separation(Moving(), PlanSettings()), (0.0, 1))
    assertEquals(separation(Moving(2), PlanSettings()), (3.0, 0))
    assertEquals(separation(Moving(0.5), PlanSettings()), (1.5, 0))
    assertEquals(separation(Moving(2), PlanSettings(separationM = 5)), (6.0, 0))
    val kept = PlanSettings(separationM = 5, kept = Vector(Kept.Apart(7)))
    assertEquals(separation(Moving(), kept), (8.0, 1))

  test("every speed stays below a limit by a tenth of it"):
    val kept  = PlanSettings(kept = Vector(Kept.NoFaster(5), Kept.NoFaster(2), Kept.Above(1)))
    val posed = teamPart(Moving(), kept).objective
    assertEquals((posed.limits.maxSpeed, posed.cruiseSpeed), (1.8, 1.8))
    val alone = pursuit(kept).pose(Memory(0.25, None, 7), view, now).objective
    assertEquals((alone.limits.minSpeed, alone.limits.maxSpeed, alone.cruiseSpeed), (1.8, 1.8, 1.8))
    assertEquals(PlanSettings(kept = Vector(Kept.NoFaster(5))).speedMps(3), 3.0)

  test("a vehicle keeps its altitude if floor and ceiling allow it; else it flies a metre inside, or midway"):
    def flown(kept: Kept*) = PlanSettings(kept = kept.toVector).altitudeM(5)
    assertEquals(flown(), 5.0)
    assertEquals(flown(Kept.Above(4), Kept.Below(6)), 5.0)
    assertEquals(flown(Kept.Above(2), Kept.Above(7)), 8.0)
    assertEquals(flown(Kept.Below(9), Kept.Below(4)), 3.0)
    assertEquals(flown(Kept.Above(7), Kept.Below(8)), 7.5)

  test("after a longer pause, the first turn of a team's vehicle is limited to a radian"):
    def mostAtOnce(pauseS: Double) =
      teamPart(
        Moving(),
        PlanSettings(step = Span.ofMillis(100)),
        Some(Span.ofSeconds(pauseS))
      ).objective.limits.maxTurnRate
    assertEquals(mostAtOnce(0.05), 1 / 0.1)
    assertEquals(mostAtOnce(0.4), 1 / 0.4)

  test(
    "vehicles of a team that do not plan are avoided only if a separation is configured"
  ):
    val mixed = Fleet(fleet.agents.zipWithIndex.map((agent, place) =>
      if place == pursuer then agent.copy(policy = Moving()) else agent.copy(policy = Together)
    ))
    def posed(separationM: Double) =
      teamwork(mixed, Moving(), PlanSettings(separationM = separationM))
        .pose(Memory(0.25, None, 7), view, now)
    assertEquals(posed(0.5).situation.others.size, fleet.agents.size - 1)
    assertEquals(posed(0).situation.others.size, 0)
    assert(!posed(0).objective.separation.isKept)

  private object Together extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) = (seen.along(0, 1), ())

  test("instead of a plan, the policy of a team's vehicle decides its heading and its speed"):
    val team             = Fleet(fleet.agents.map(_.copy(policy = Moving())))
    val planning         = teamwork(team, Moving(), PlanSettings())
    val (decision, made) = decidedBy(planning, isOld = true)
    assertEqualsDouble(decision.heading.value, 0, 1e-12)
    assertEquals((decision.action.speed, made.plan.byPolicy), (MetresPerSecond(3), true))

  test(
    "a plan is used if it saves a tenth of a metre against the policy's manoeuvre; else the policy decides"
  ):
    val team                 = Fleet(fleet.agents.map(_.copy(policy = Moving())))
    val planning             = teamwork(team, Moving(), PlanSettings())
    val memory               = Memory(0.25, Some(now - Span.ofMillis(200)), 7)
    val posed                = planning.pose(memory, view, now)
    val rollout              = ManoeuvreRollout(posed.situation, posed.objective, planning.planner.dtS)
    val plans                = JointPlanner().resumed(PlanProblem(planning.planner, Vector(posed)), None)
    val speeds               = (0 to 500).map(_ / 100.0)
    def flown(speed: Double) = Manoeuvre.straight(speed, planning.planner.steps)
    def begun(suggested: Double, planned: Double) =
      val part      = posed.copy(situation = posed.situation.copy(suggested = Vector(flown(suggested))))
      val plan      = plans.plans.head.copy(manoeuvre = flown(planned))
      val (_, made) = planning.decide(memory, view, now, part, plan, Vector.empty, isOld = false)
      made.decision.action.speed.value
    val costs                                   = speeds.map(speed => speed -> rollout.fly(flown(speed)).cost)
    val (best, least)                           = costs.minBy(_._2)
    def worse(from: Double, to: Double): Double =
      costs.find((_, cost) => cost - least > from && cost - least < to).getOrElse(fail(s"$costs"))._1
    for suggested <- Seq(worse(0.03, 0.09), worse(0.11, 0.5)) do
      val saved = costs.toMap.apply(suggested) - least
      assertEqualsDouble(begun(suggested, best), if saved < 0.1 then suggested else best, 1e-6)

  test("if no search finished for a vehicle for more than half a horizon, its policy decides"):
    val settings = PlanSettings(horizonSteps = 20, step = Span.ofMillis(50))
    val joint    = jointly(fleet, settings).getOrElse(fail("nobody plans"))
    val memories = joint.vehicles.map(_ => Memory(0.25, Some(now - Span.ofMillis(200)), 7))
    val views    = joint.vehicles.map(_ => view)
    val parts    = joint.pose(memories, views, now)
    val plans    = JointPlanner().resumed(PlanProblem(joint.planner, parts), None)
    def byPolicy(unsearchedS: Double*) =
      val answer = planning.PlanStage.Answer(plans, Vector(0), unsearchedS.toVector)
      joint.decide(memories, views, now, parts, answer)._2.map(_.plan.byPolicy)
    assertEquals(byPolicy(0.5, 0.501), Vector(false, true))
    assertEquals(byPolicy(0.501, 0), Vector(true, false))
    assertEquals(
      jointly(Fleet(fleet.agents.map(_.copy(policy = Together))), settings).map(_.vehicles),
      None
    )
