package skein.lanes

import skein.forward.{DelayTable, Delays, Pair, LoopTiming, ScoredRollout, VelocityResponses}
import skein.policy.{ChauffeurEvader, Policy}
import skein.signal.SplitMix64
import skein.simd.WorldRandom

/** Policies that the product does not contain are compiled to SIMD as they are written. */
class UnseenPolicySuite extends munit.FunSuite:
  import UnseenPolicySuite.*

  private val model = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val short = Pair.paper.copy(durationS = 5)

  for
    (name, draw)     <- Unseen
    (timing, shared) <- Seq(
      LoopTiming.Stream()     -> true,
      LoopTiming.Sequential() -> true,
      LoopTiming.Stream()     -> false,
      LoopTiming.Futures()    -> false
    )
  do
    test(s"$name, ${timing.productPrefix}, ${
        if shared then "one episode" else "delays of their own"
      }: as by the scalar reference"):
      val random   = SplitMix64(7)
      val pursuers = Vector.fill(128)(draw(random))
      val evader   = ChauffeurEvader()
      val worlds   = new PairWorlds:
        def size: Int                       = pursuers.size
        override def shareEpisodes: Boolean = shared
        def key(world: Int): Int            = WorldRandom.key(1, 0, if shared then 0 else world)
        def link(world: Int): Delays        = DelayTable.vpn
        def pursuer(world: Int): Policy     = pursuers(world)
        def evader(world: Int): Policy      = UnseenPolicySuite.Evader
      val batch = PairBatch(short, timing, model, 1)
      assert(
        batch.engine(pursuers.head, evader, shared, Seq(DelayTable.vpn)).isFast,
        batch.engine(pursuers.head, evader, shared, Seq(DelayTable.vpn)).text
      )
      val flown = batch.fly(worlds)
      val off   = pursuers.indices.map: world =>
        val duel = Pair(
          short.pursuer.copy(policy = pursuers(world)),
          short.evader.copy(policy = evader),
          short.durationS
        )
        val scalar = ScoredRollout(duel.engagement, timing, DelayTable.vpn, model).fly(worlds.key(world))
        (flown.meanDistanceM(world) - scalar.meanDistanceM).abs max
          (flown.minDistanceM(world) - scalar.minDistanceM).abs max
          (flown.pursuerEffortRad(world) - scalar.pursuerEffortRad).abs
      assert(off.max < 5e-3, off.sorted.takeRight(10).mkString(" "))

object UnseenPolicySuite:
  val Evader: ChauffeurEvader = ChauffeurEvader()

  val Unseen: Seq[(String, SplitMix64 => Policy)] = Seq(
    "memory" -> (random =>
      TrendPursuer(random.nextDouble(), 0.2 + random.nextDouble(), 0.5 + random.nextDouble())
    ),
    "ages"    -> (random => AgeAwarePursuer(10, random.nextDouble(), 0.5 + random.nextDouble())),
    "network" -> (random =>
      RectifiedNetwork(
        Array.fill(RectifiedNetwork.Weights)(random.nextDouble() - 0.5),
        0.5 + random.nextDouble()
      )
    )
  )
