package skein.learn

import skein.environment.EnvironmentSettings
import skein.forward.{
  DelayTable,
  Delays,
  Engagement,
  LinkDelays,
  LoopTiming,
  PlantResponse,
  SpatialResponse
}
import skein.lanes.{ScalarTeam, TeamBatch, TeamCandidate, TeamWorlds}
import skein.lanes.score.Judged
import skein.policy.*
import skein.scenario.{PaperDuel, Positions, Quantity, Reduction, Scenarios, Separation}
import skein.signal.{LatencyDistribution, LatencyProfile, SplitMix64}
import skein.units.Span
import skein.vehicle.{ReducedModel, TiltModel}

class SideTaskSimulation extends munit.FunSuite:
  import SideTaskSimulation.InSpace
  private val game = Engagement.of(PaperDuel(altitudeM = 20).fleet, 20)

  private given Scenarios = Scenarios.ours
  private val none = LinkDelays.of(LatencyProfile.Steady("none", LatencyDistribution.Constant(Span.Zero)))

  private def drawn(hidden: Int*) =
    Network(LearnerSpace.Level.inputs +: hidden.toVector :+ 2).draw(SplitMix64(3))

  /** The sum of an episode's rewards, by the means of an actor. */
  private def episode(task: SideTask, actor: Network): Double =
    val pass = Pass(actor.widths, 1)
    task.begin(0, actor)
    var reward = 0.0
    var isOver = false
    while !isOver do
      System.arraycopy(task.seen, 0, pass.input, 0, task.observations)
      pass.forward(actor, 0, 1)
      task.step(Array.tabulate(task.actions)(action => math.tanh(pass.output(action)).toFloat))
      reward += task.rewards(0)
      isOver = task.ended(0)
    reward

  test("a policy made from an actor makes the actor's decisions"):
    val actor  = drawn(16, 8)
    val policy = LearnedPolicy(LearnedPolicy.shape(Vector(16, 8)), SideTask.parameters(actor), 1, 0)
    val seen   = PlanarObservation(3, 9, -4, 2, 0.7, -2, 0.1, 0.15, 0.2)
    val pass   = Pass(actor.widths, 1)
    for (number, at) <- seen.fromOwnHeading.zip(LearnerSpace.Level.scales).map(_ / _).zipWithIndex do
      pass.input(at) = number.toFloat
    pass.forward(actor, 0, 1)
    assertEqualsDouble(policy.shares(seen.fromOwnHeading)(0), math.tanh(pass.output(0)), 1e-6)

  for side <- Seq("pursuer", "evader") do
    test(s"the $side's episode equals that of its policy in forward simulation"):
      val actor      = drawn(8)
      val (rate, at) = if side == "pursuer" then (1.0, 0.0) else (0.0, math.Pi)
      val policy     = LearnedPolicy(LearnedPolicy.shape(Vector(8)), SideTask.parameters(actor), rate, at)
      // Without a network, delays do not vary at random.
      val settings = EnvironmentSettings(learners = side, link = "none", episodeS = 20)
      val reward   = episode(SideTask.of(settings, None, 1, 1).fold(fail(_), identity), actor)
      val both     = game.flownBy(if side == "pursuer" then Role.Pursuer else Role.Evader, policy)
      val team     = TeamCandidate(both, Vector(Judged(Separation, Reduction.Mean, 0)))
      val flownM   = scalar.fly(team, none, 1)(0)
      val mean     = math.abs(reward) * 100 / 200
      assertEqualsDouble(mean, flownM, 0.05)

  test("a climbing pursuer's episode equals that of its policy, with SIMD and by the scalar engine"):
    val actor    = Network(LearnerSpace.Climbing.inputs +: Vector(8) :+ 4).draw(SplitMix64(3))
    val family   = PolicyFamily.learned(LearnedPolicy.shape(Vector(8), LearnerSpace.Climbing))
    val policy   = family.policy(SideTask.parameters(actor) ++ Vector(1.0, 0.0, 2.0))
    val settings = EnvironmentSettings(link = "none", episodeS = 20, climbMps = 2)
    val task     = SideTask.of(settings, None, 1, 1).fold(fail(_), identity)
    val reward   = episode(task, actor)
    val team  = TeamCandidate(game.flownBy(Role.Pursuer, policy), Vector(Judged(InSpace, Reduction.Mean, 0)))
    val means =
      for isReference <- Seq(false, true) yield
        val batch =
          TeamBatch(LoopTiming.Stream(), SpatialResponse(TiltModel.AirSim), 1, isReference = isReference)
        val worlds = OneTeam(team, 1, none)
        assertEquals(batch.engine(team, shareEpisodes = true, Seq(none)).fliesByLanes, !isReference)
        batch.fly(worlds).values(0)(0).toDouble
    assertEqualsDouble(means(0), means(1), 2e-3)
    assertEqualsDouble(math.abs(reward) * 100 / 200, means(1), 0.05)

  test("a learned policy with SIMD equals the scalar reference"):
    val policy  = LearnedPolicy(LearnedPolicy.shape(Vector(16, 16)), SideTask.parameters(drawn(16, 16)), 1, 0)
    val pursued = game.flownBy(Role.Pursuer, policy)
    val team    = TeamCandidate(pursued, Vector(Judged(Separation, Reduction.Mean, 0)))
    val worlds  = OneTeam(team, 4, DelayTable.vpn)
    val batch   = TeamBatch(LoopTiming.Stream(), PlantResponse(ReducedModel.AirSimLag), 1)
    assert(batch.engine(team, shareEpisodes = true, Seq(DelayTable.vpn)).isFast)
    val flown = batch.fly(worlds)
    for world <- 0 until 4 do
      assertEqualsDouble(flown.values(0)(world).toDouble, scalar.fly(team, DelayTable.vpn, world)(0), 0.05)

  private def scalar = ScalarTeam(LoopTiming.Stream(), PlantResponse(ReducedModel.AirSimLag))

  private final class OneTeam(team: TeamCandidate, val size: Int, over: Delays) extends TeamWorlds:
    override def shareEpisodes               = true
    def key(world: Int): Int                 = world
    def link(world: Int): Delays             = over
    def candidate(world: Int): TeamCandidate = team

object SideTaskSimulation:
  /** Distance between the two in space. */
  object InSpace extends Quantity:
    def of(positions: Positions): Double =
      StrictMath.hypot(positions.distanceM(0, 1), positions.downM(0) - positions.downM(1))
