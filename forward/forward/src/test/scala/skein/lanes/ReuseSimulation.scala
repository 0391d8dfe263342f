package skein.lanes

import skein.forward.*
import skein.lanes.AnyPolicySimulation.*
import skein.lanes.score.Judged
import skein.optimise.LatencyBudget
import skein.policy.*
import skein.scenario.{Quantity, Reduction}
import skein.simd.WorldRandom
import skein.testing.Optimised
import skein.units.*
import skein.vehicle.TiltModel

/** Arrays are reused from batch to batch, and worlds leave nothing in them that changes the next worlds. */
class ReuseSimulation extends munit.FunSuite, Optimised:
  import ReuseSimulation.*

  private def candidates(count: Int): Vector[TeamCandidate] = Vector.tabulate(count): number =>
    val fleet = Fleet(policies(0.2 + 0.05 * number).zipWithIndex.map: (policy, i) =>
      Agent(
        s"V$i",
        if i == 0 then Role.Evader else Role.Pursuer,
        MetresPerSecond(4 + i),
        Vector3(11 * i, 5 * (i % 2) + 0.3 * i * i, -20),
        Radians(0.4 * number - i),
        policy
      ))
    TeamCandidate(Engagement.of(fleet, 4), Vector(Judged(Nearest, Reduction.Mean, 0)))

  /** For loops that predict, a link so slow that requests exceed the window and some wait. */
  private def link(timing: LoopTiming) = timing match
    case _: LoopTiming.Predictive => DelayTable.of(LatencyBudget.link(300, 300).get)
    case _                        => DelayTable.vpn

  private def worlds(of: Vector[TeamCandidate], seed: Int, over: Delays, share: Boolean) = new TeamWorlds:
    def size: Int                            = of.size
    override def shareEpisodes: Boolean      = share
    def key(world: Int): Int                 = WorldRandom.key(seed, 0, if share then 0 else world)
    def link(world: Int): Delays             = over
    def candidate(world: Int): TeamCandidate = of(world)

  private val lag = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  for
    (name, timing, model) <-
      (TestLoops.unpredicted :+ LoopTiming.Predictive(predictor = lag.predictor)).map(("lag", _, lag)) :+
        ("in space", LoopTiming.Stream(), SpatialResponse(TiltModel.AirSim))
    share <- if timing.isInstanceOf[LoopTiming.Paused] then Seq(true) else Seq(true, false)
  do
    val delays = if share then "shared" else "own"
    test(s"$name, $timing, $delays delays: worlds have their earlier results again after other worlds"):
      val over           = link(timing)
      val batch          = TeamBatch(timing, model, threads = 1)
      val (these, those) = (candidates(9), candidates(3).reverse)
      assert(batch.engine(these.head, share, Seq(over)).fliesByLanes)
      def flown() = batch.fly(worlds(these, 1, over, share)).values.map(_.toVector)
      val before  = flown()
      val between = batch.fly(worlds(those, 2, over, share)).values.map(_.toVector)
      assertEquals(flown(), before)
      assert(before.head.distinct.size > 5 && between.head(0) != before.head(0), before)

object ReuseSimulation:
  private def policies(rate: Double): Vector[Policy] =
    Vector(Weaving(rate), Ages, Mirror, Trailing, Surrounding(0, 7, 8))

  /** Smallest distance of another vehicle from the first, m. */
  private case object Nearest extends Quantity:
    def of(at: skein.scenario.Positions): Double =
      (1 until at.count).map(i =>
        StrictMath.hypot(at.northM(i) - at.northM(0), at.eastM(i) - at.eastM(0))
      ).min
