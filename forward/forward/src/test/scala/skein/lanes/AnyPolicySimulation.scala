package skein.lanes

import skein.forward.*
import skein.lanes.score.{Judged, OfMoment}
import skein.optimise.LatencyBudget
import skein.policy.*
import skein.scenario.Reduction
import skein.signal.SplitMix64
import skein.simd.WorldRandom
import skein.testing.{Lengthy, Optimised}
import skein.units.*
import skein.vehicle.ReducedModel

/** Policies of every kind, mixed in one team and in duels, have equal results with SIMD and by the scalar
  * engine.
  */
class AnyPolicySimulation extends munit.FunSuite, Lengthy, Optimised:
  import AnyPolicySimulation.*

  private val lag   = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val loops = TestLoops.unpredicted :+ LoopTiming.Predictive(predictor = lag.predictor)

  private def within(random: SplitMix64, least: Double, most: Double) =
    least + (most - least) * random.nextDouble()

  private def fleet(random: SplitMix64, policies: (Role, SplitMix64 => Policy)*) =
    Fleet(policies.toVector.zipWithIndex.map:
      case ((role, draw), i) =>
        Agent(
          s"V$i",
          role,
          MetresPerSecond(within(random, 4, 9)),
          Vector3(12 * i + within(random, 0, 3), 5 * (i % 2) + 0.3 * i * i, -20),
          Radians(within(random, -3, 3)),
          draw(random)
        ))

  private val teams: Seq[(String, SplitMix64 => Fleet)] = Seq(
    "the chase of the README against the paper's evader" ->
      (fleet(_, Role.Evader -> (_ => PaperEvader()), Role.Pursuer -> (_ => Chase))),
    "a weaver with a memory against one that goes by ages" ->
      (fleet(_, Role.Evader -> (random => Weaving(random.nextDouble())), Role.Pursuer -> (_ => Ages))),
    "five of different kinds, who know what others are told" -> (fleet(
      _,
      Role.Evader  -> (random => Circling(random.nextDouble())),
      Role.Pursuer -> (_ => Mirror),
      Role.Pursuer -> (random => LeadPursuit(random.nextDouble())),
      Role.Pursuer -> (random => Surrounding(0, within(random, 5, 9), 8)),
      Role.Pursuer -> (_ => Trailing)
    ))
  )

  /** Candidates with one team each, and the vehicles' final and mean positions as scores. */
  private def candidates(draw: SplitMix64 => Fleet, count: Int, durationS: Double): Vector[TeamCandidate] =
    val random = SplitMix64(11)
    Vector.fill(count):
      val team   = Engagement.of(draw(random), durationS)
      val judged =
        for
          vehicle   <- team.agents.indices.toVector
          along     <- Seq(North(vehicle), East(vehicle))
          reduction <- Seq(OfMoment.Newest, Reduction.Mean)
        yield Judged(along, reduction, 0)
      TeamCandidate(team, judged)

  private def worlds(of: Vector[TeamCandidate], over: Delays, share: Boolean) = new TeamWorlds:
    def size: Int                            = of.size
    override def shareEpisodes: Boolean      = share
    def key(world: Int): Int                 = WorldRandom.key(3, 1, if share then 0 else world)
    def link(world: Int): Delays             = over
    def candidate(world: Int): TeamCandidate = of(world)

  private def agree(
      draw: SplitMix64 => Fleet,
      timing: LoopTiming,
      plant: VelocityResponse,
      over: Delays,
      share: Boolean,
      mostM: Double = 4e-3
  ): Unit =
    val all    = worlds(candidates(draw, 60, 5), over, share)
    val batch  = TeamBatch(timing, plant, threads = 1)
    val engine = batch.engine(all.candidate(0), share, Seq(over)).text
    assert(engine.startsWith("SIMD"), engine)
    val flown  = batch.fly(all)
    val scalar = ScalarTeam(timing, plant)
    val offs   =
      for world <- 0 until all.size by 7 yield
        val truth = scalar.fly(all.candidate(world), all.link(world), all.key(world))
        truth.indices.map(number => (flown.values(number)(world) - truth(number)).abs).max
    // Where two are as near, rounding decides against whom: of nine worlds one may.
    val sorted = offs.sorted
    assert(sorted.init.forall(_ < mostM), s"$sorted")

  for (name, draw) <- teams; timing <- loops do
    test(s"$name, $timing over vpn: candidates with shared delays agree with the scalar engine, 5 s to 4 mm"):
      agree(draw, timing, lag, DelayTable.vpn, share = true)

    if !timing.isInstanceOf[LoopTiming.Paused] then
      test(s"$name, $timing over vpn, own delays: every world agrees with the scalar engine, 5 s to 4 mm"):
        agree(draw, timing, lag, DelayTable.vpn, share = false)

  for (name, draw) <- teams do
    test(s"$name, stream over a link with jitter, drag, own delays: SIMD agrees with the scalar engine"):
      val wild = DelayTable.of(LatencyBudget.link(110, 60).get)
      agree(draw, LoopTiming.Stream(), PlantResponse(ReducedModel.AirSim), wild, share = false)

    test(s"$name, stream over vpn, quadrotors: SIMD agrees with the scalar engine"):
      agree(draw, LoopTiming.Stream(), VelocityResponses.quadrotor(), DelayTable.vpn, share = true)

  test(
    "policies that turn their vehicle, or read altitudes, use SIMD with models of motion, but not with " +
      "quadrotors"
  ):
    val quadrotors = TeamBatch(LoopTiming.Stream(), VelocityResponses.quadrotor(), threads = 1)
    val plants     = TeamBatch(LoopTiming.Stream(), lag, threads = 1)
    for policy <- Seq(Turning, Upwards) do
      val one = candidates(fleet(_, Role.Evader -> (_ => policy), Role.Pursuer -> (_ => Chase)), 1, 2).head
      def fliesByLanes(by: TeamBatch) = by.engine(one, shareEpisodes = true, Seq(DelayTable.vpn)).fliesByLanes
      assert(fliesByLanes(plants))
      assert(!fliesByLanes(quadrotors))

  test("a policy that does not fly on at its altitude is refused with its source line"):
    def refusal(policy: Policy) = intercept[IllegalArgumentException]:
      Engagement.of(fleet(SplitMix64(1), Role.Evader -> (_ => policy), Role.Pursuer -> (_ => Chase)))
    assert(clue(refusal(Landing).getMessage).contains("it decides for Action.Land"))
    assert(clue(refusal(Landing).getMessage).contains("AnyPolicySimulation.scala:"))
    assert(clue(refusal(Halving).getMessage).contains("a loop whose end depends on what is observed"))
    assert(clue(refusal(Higher(-30)).getMessage).contains("it leaves the altitude"))

  test(
    "a policy that falsely promises to be planar uses the scalar engine, and fails once it breaks the promise"
  ):
    val team = fleet(_, Role.Evader -> (_ => Promising), Role.Pursuer -> (_ => Chase))
    val one  = candidates(team, 1, 5).head
    val told =
      TeamBatch(LoopTiming.Stream(), lag, 1).engine(one, shareEpisodes = true, Seq(DelayTable.vpn)).text
    assert(clue(told).startsWith("scalar: a policy is no formula: "))
    val failed = intercept[OwnFailure](ScalarTeam(LoopTiming.Stream(), lag).fly(one, DelayTable.vpn, 4))
    assert(clue(failed.getMessage).startsWith("the policy Promising decided for Land"))

object AnyPolicySimulation:
  private def towards(seen: Observation, vehicle: Int) =
    seen.vehicles(vehicle).kinematics.positionNed - seen.own.kinematics.positionNed

  private def heading(seen: Observation, way: Vector3, by: Double = 0) =
    Action.Along(Radians(StrictMath.atan2(way.y, way.x) + by), seen.cruise, seen.startDown)

  // As examples/chase has it.
  case object Chase extends Policy.Memoryless:
    def action(seen: Observation): Action = heading(seen, towards(seen, seen.opponent))

  final case class Phase(angle: Double, isLeft: Boolean)
  final case class Weaving(rate: Double) extends Policy:
    type Memory = Phase
    def start: Phase                                              = Phase(0.25, true)
    def choose(seen: Observation, memory: Phase): (Action, Phase) =
      val angle = memory.angle + rate * seen.elapsed.toSeconds * (if memory.isLeft then 1 else -1)
      val next  =
        if angle.abs > 0.5 then Phase(angle.min(0.5).max(-0.5), !memory.isLeft) else memory.copy(angle)
      (heading(seen, towards(seen, seen.opponent) * -1, next.angle), next)

  final case class Circling(rate: Double) extends Policy.Memoryless:
    def action(seen: Observation): Action =
      Action.Along(Radians(rate * seen.time.toSeconds), MetresPerSecond(5), seen.startDown)

  case object Ages extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val other = seen.vehicles(seen.opponent)
      val late  = if other.age > Span.ofMillis(200) then Span.ofMillis(200) else other.age
      val ahead = other.kinematics.velocityNed * (late + seen.actsIn).toSeconds
      heading(seen, towards(seen, seen.opponent) + ahead, seen.own.age.toSeconds)

  case object Mirror extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val (other, own) = (seen.headings(seen.opponent).value, seen.headings(seen.self).value)
      val way          = towards(seen, seen.opponent)
      Action.VelocityAt(
        way.x / 5 + 2 * StrictMath.cos(other) + StrictMath.cos(own),
        way.y / 5 + 2 * StrictMath.sin(other) + StrictMath.sin(own),
        seen.startDown
      )

  case object Trailing extends Policy:
    type Memory = Vector[Double]
    def start: Vector[Double]                                                       = Vector(0.0, 0.0, 0.0)
    def choose(seen: Observation, memory: Vector[Double]): (Action, Vector[Double]) =
      val way  = towards(seen, seen.vehicles.indices.filter(_ != seen.self).head)
      val next = memory.tail :+ StrictMath.atan2(way.y, way.x)
      val mean = next.map(_ - next.last).sum / next.size
      (heading(seen, way, 0.2 * mean.max(-1).min(1)), next)

  case object Turning extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val way = towards(seen, seen.opponent)
      Action.VelocityAt(way.x / 5, way.y / 5, seen.startDown, Yaw.Forward)

  case object Upwards extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val own = seen.own.kinematics.positionNed
      Action.VelocityAt(own.z / 5, 1, seen.startDown)

  case object Landing extends Policy.Memoryless:
    def action(seen: Observation): Action = Action.Land

  final case class Higher(downM: Double) extends Policy.Memoryless:
    def action(seen: Observation): Action = Action.VelocityAt(1, 2, Metres(downM))

  case object Halving extends Policy.Memoryless:
    def action(seen: Observation): Action =
      var north = seen.own.kinematics.positionNed.x
      while north > 1 do north /= 2
      Action.VelocityAt(north, 1, seen.startDown)

  case object Promising extends Policy.Memoryless:
    override def isPlanar: Boolean        = true
    def action(seen: Observation): Action =
      if seen.decisions > 20 then Action.Land else heading(seen, towards(seen, seen.opponent))
