package skein.lanes

import skein.forward.{DelayTable, Delays, Pair, LoopTiming, PlantResponse}
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.vehicle.ReducedModel

/** Efforts are computed where they are requested, and nothing else depends on that. */
class EffortSuite extends munit.FunSuite:
  private val duel = Pair.paper.copy(durationS = 5)

  private def flown(shared: Boolean, efforts: Boolean, timing: LoopTiming): PairOutcomes =
    val worlds = new PairWorlds:
      def size: Int                       = 200
      override def shareEpisodes: Boolean = shared
      override def asked: Set[PairNumber] =
        if efforts then super.asked else Set(PairNumber.MeanDistance, PairNumber.MinDistance)
      def key(world: Int): Int        = WorldRandom.key(1, 0, if shared then world % 2 else world)
      def link(world: Int): Delays    = DelayTable.vpn
      def pursuer(world: Int): Policy = PaperPursuer(0.6 + 0.002 * world)
      def evader(world: Int): Policy  = PaperEvader()
    PairBatch(duel, timing, PlantResponse(ReducedModel.AirSimLag), threads = 1).fly(worlds)

  for
    shared <- Seq(true, false)
    timing <- Seq(
      LoopTiming.Stream(),
      LoopTiming.Predictive(predictor = PlantResponse(ReducedModel.AirSimLag).predictor)
    ) // by lanes, and shared or scalar
  do
    test(s"${timing.productPrefix}, ${if shared then "one episode for all" else "delays of their own"}"):
      val (with_, without) = (flown(shared, true, timing), flown(shared, false, timing))
      for world <- 0 until 200 do
        assert(with_.pursuerEffortRad(world) > 0 && with_.evaderEffortRad(world) > 0, s"world $world")
        assert(without.pursuerEffortRad(world).isNaN && without.evaderEffortRad(world).isNaN, s"world $world")
        assertEqualsFloat(without.meanDistanceM(world), with_.meanDistanceM(world), 1e-3f, s"world $world")
        assertEqualsFloat(without.minDistanceM(world), with_.minDistanceM(world), 1e-3f, s"world $world")
