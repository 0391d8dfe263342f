package skein.forward

import skein.policy.*
import skein.scenario.PaperDuel
import skein.units.*
import skein.vehicle.ReducedModel

class EngagementSuite extends munit.FunSuite:
  private val duel = PaperDuel().fleet.agents

  private def agent(role: Role, number: Int, north: Double, east: Double, policy: Policy): Agent =
    duel
      .find(_.role == role)
      .getOrElse(duel.head.copy(role = role))
      .copy(name = s"$role$number", startPositionNed = Vector3(north, east, -20), policy = policy)

  private def places(rollout: Rollout, key: Int = 7): Vector[(Int, Double, Double)] =
    val seen = Vector.newBuilder[(Int, Double, Double)]
    rollout.fly(
      key,
      observer = new LoopObserver:
        override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
          seen += ((vehicle, x, y))
    )
    seen.result()

  private val loops = Seq(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(asking = Asking(spreadS = 0.1, inOrder = true), decideThenPace = true)
  )

  test("a scenario of one pursuer and one evader is the duel, to the last bit, in every loop"):
    for loop <- loops do
      val one = ScoredRollout(
        Engagement.of(PaperDuel().fleet),
        loop,
        DelayTable.vpn,
        PlantResponse(ReducedModel.AirSimLag)
      ).fly(3)
      val same =
        ScoredRollout(
          Pair.paper.engagement,
          loop,
          DelayTable.vpn,
          PlantResponse(ReducedModel.AirSimLag)
        ).fly(3)
      assertEquals(one, same, loop.toString)

  test("duels far from each other are simulated like each alone"):
    val far      = 4096.0
    val scenario = Fleet(
      Vector(0.0, far).zipWithIndex.flatMap((east, i) =>
        duel.map(agent =>
          agent.copy(
            name = s"${agent.name}$i",
            startPositionNed = agent.startPositionNed + Vector3(0, east, 0)
          )
        )
      )
    )
    val alone =
      places(Rollout(
        Pair.paper.engagement,
        LoopTiming.Paused(),
        DelayTable.none,
        PlantResponse(ReducedModel.AirSimLag)
      ))
    val together =
      places(Rollout(
        Engagement.of(scenario),
        LoopTiming.Paused(),
        DelayTable.none,
        PlantResponse(ReducedModel.AirSimLag)
      ))
    for pair <- 0 to 1 do
      val its =
        together.collect { case (vehicle, x, y) if vehicle / 2 == pair => (vehicle % 2, x, y - far * pair) }
      assertEquals(its.size, alone.size)
      for ((vehicle, x, y), (other, x0, y0)) <- its.zip(alone) do
        assertEquals(vehicle, other)
        assertEqualsDouble(x, x0, 1e-6)
        assertEqualsDouble(y, y0, 1e-6)

  test("a pursuer turns to another evader as soon as that one is seen nearer"):
    // The first evader runs north; the second comes in from the east and stays nearer from some moment on.
    val scenario = Fleet(
      Vector(
        agent(Role.Evader, 1, 20, 0, LeadAway(0)),
        agent(Role.Evader, 2, 5, 30, LeadAway(math.Pi)),
        agent(Role.Pursuer, 1, 0, 0, PurePursuit(3))
      )
    )
    val seen = places(Rollout(
      Engagement.of(scenario, 12),
      LoopTiming.Stream(),
      DelayTable.direct,
      VelocityResponses.Ideal
    ))
    val steps    = seen.grouped(3).toVector.map(_.map((_, x, y) => (x, y)))
    val distance = steps.map(at => (0 to 1).map(e => math.hypot(at(e)._1 - at(2)._1, at(e)._2 - at(2)._2)))
    assert(distance.head(0) < distance.head(1), distance.head)
    assert(distance.last(0) > 0 && distance.exists(_.min < 1.5), distance.map(_.min).min)

  test("an agent with a permanent assignment keeps its rival, however near others come"):
    val agents = Vector(
      agent(Role.Evader, 1, 20, 0, LeadAway(0)),
      agent(Role.Evader, 2, 5, 0, LeadAway(math.Pi / 2)),
      agent(Role.Pursuer, 1, 0, 0, PurePursuit(3))
    )
    val nearest              = Engagement.of(Fleet(agents), 3)
    val assigned             = nearest.copy(assignment = Assignment(Vector(Vector(2), Vector(2), Vector(0))))
    def last(of: Engagement) =
      places(Rollout(of, LoopTiming.Paused(), DelayTable.none, VelocityResponses.Ideal)).last
    assert(last(nearest)._3 > 5, s"${last(nearest)}: the nearer evader runs east")
    assertEqualsDouble(last(assigned)._3, 0, 1e-9)

  test("any pursuer that comes near captures the evader, and each evader has its own outcome"):
    val scenario = Fleet(
      Vector(
        agent(Role.Evader, 1, 0, 0, KeepHeading),
        agent(Role.Evader, 2, 500, 0, KeepHeading),
        agent(Role.Pursuer, 1, -40, 0, PurePursuit(3)),
        agent(Role.Pursuer, 2, 60, 0, PurePursuit(3))
      )
    )
    val rollout =
      ScoredRollout(Engagement.of(scenario, 8), LoopTiming.Paused(), DelayTable.none, VelocityResponses.Ideal)
    val flown = rollout.fly(0, captureRadiusM = 2)
    val each  = rollout.evaderOutcomes
    // The pursuer behind is 40 m away and gains 5 m/s; the one ahead closes faster.
    assert(each(0).captureS < 8 && each(0).minDistanceM < 2, each)
    assert(each(1).captureS.isInfinite, each)
    assert(flown.captureS.isInfinite && flown.minDistanceM == each(0).minDistanceM, flown)
    assertEqualsDouble(flown.meanDistanceM, (each(0).meanDistanceM + each(1).meanDistanceM) / 2, 1e-12)

  test("every message of up to 64 vehicles has a separate delay, and two vehicles keep their former lines"):
    val all   = 0 until Engagement.Most
    val lines =
      (for
        asker <- all; vehicle <- all;
        line  <- Seq(Delays.question(asker, vehicle), Delays.answer(asker, vehicle))
      yield line) ++ all.flatMap(vehicle => Seq(Delays.command(vehicle), Delays.acknowledgement(vehicle)))
    assertEquals(lines.distinct.size, lines.size)
    assertEquals(
      Seq(
        Delays.question(0, 0),
        Delays.answer(0, 1),
        Delays.question(1, 0),
        Delays.answer(1, 1),
        Delays.command(0),
        Delays.acknowledgement(1)
      ),
      Seq(0, 3, 4, 7, 8, 11)
    )

  test(
    "in a team without sides each vehicle is scored by the distance to " +
      "the nearest other, and policies choose the speed"
  ):
    // From north to south, towards the middle one, at 1, 2 and 3 m/s.
    val speeds = Seq(1.0, 2.0, 3.0)
    val agents = Vector(30.0, 0.0, -50.0)
      .zip(speeds)
      .zipWithIndex
      .map:
        case ((north, speed), number) =>
          agent(Role.Traveller, number, north, 0, KeepHeading).copy(policy = ToSecond(speed))
    val rollout = ScoredRollout(
      Engagement.of(Fleet(agents), 5),
      LoopTiming.Paused(),
      DelayTable.none,
      VelocityResponses.Ideal
    )
    val flown = rollout.fly(0)
    // The middle one flies north, at 2 m/s: the northern one comes 3 m/s nearer, the southern one 1 m/s.
    val each = rollout.evaderOutcomes.map(_.minDistanceM)
    for (actual, expected) <- each.zip(Seq(15.0, 15.0, 45.0)) do assertEqualsDouble(actual, expected, 1e-6)
    assertEquals(flown.minDistanceM, each.min)

  test("an engagement needs either both sides or neither"):
    val mixed = Seq(Role.Evader, Role.Pursuer, Role.Traveller).zipWithIndex.map((role, number) =>
      agent(role, number, 10 * number, 0, KeepHeading)
    )
    val _ = intercept[IllegalArgumentException](Engagement.of(Fleet(mixed.toVector)))
    val _ = intercept[IllegalArgumentException](
      Engagement(
        Vector(Pair.paper.evader, Pair.paper.evader),
        Vector(Role.Evader, Role.Evader),
        Assignment(Vector(Vector(1), Vector(0)))
      )
    )

  /** Flies north, towards the second vehicle. */
  private final case class ToSecond(mps: Double) extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      (seen.along(if seen.northM(seen.self) > seen.northM(1) then math.Pi else 0, mps), ())

  private final case class LeadAway(headingRad: Double) extends HeadingPolicy.Memoryless:
    def heading(seen: PlanarObservation): Double = headingRad
