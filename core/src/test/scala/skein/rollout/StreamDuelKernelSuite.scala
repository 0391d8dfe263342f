package skein.rollout

import scala.collection.mutable.ArrayBuffer
import skein.policy.{PaperEvader, PaperPursuer}

class StreamDuelKernelSuite extends munit.FunSuite:
  private val worlds = StreamDuelKernel.WORLDS
  private val lag    = Reduced(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  private val keys      = Array.tabulate(worlds)(WorldRandom.key(3, 1, _))
  private val turnRates = Array.tabulate(worlds)(i => 0.6f + 0.008f * i)
  private val radii     = Array.tabulate(worlds)(i => 7f + 0.02f * i)

  private def duel(world: Int, durationS: Double): Duel = Duel(
    Duel.paper.pursuer.copy(policy = PaperPursuer(turnRates(world))),
    Duel.paper.evader.copy(policy = PaperEvader(radii(world))),
    durationS
  )

  private def fly(link: DelayTable, durationS: Double): StreamDuelKernel =
    val kernel = StreamDuelKernel(Duel.paper.copy(durationS = durationS), LoopTiming.Stream(), link, lag)
    kernel.fly(keys, turnRates, radii)
    kernel

  for (name, link) <- Seq("none" -> DelayTable.none, "direct" -> DelayTable.direct, "vpn" -> DelayTable.vpn)
  do
    // In a few worlds an observation lies within a rounding error of a policy's threshold, and floats decide otherwise.
    test(s"over $name kernel and scalar reference fly the same 5 s, to 2 mm in 97 % of the worlds"):
      val kernel = fly(link, 5)
      val equal  = (0 until worlds).count: world =>
        val scalar = Rollout(duel(world, 5), LoopTiming.Stream(), link, lag).fly(keys(world))
        (kernel.minDistance(world) - scalar.minDistanceM).abs < 2e-3 &&
        (kernel.meanDistance(world) - scalar.meanDistanceM).abs < 2e-3
      assert(equal >= 0.97 * worlds, s"$equal of $worlds worlds agree")

    test(s"over $name kernel and scalar reference agree on the mean of 60 s to 1 cm"):
      val kernel  = fly(link, 60)
      val scalars = ArrayBuffer.empty[Outcome]
      for world <- 0 until worlds do
        scalars += Rollout(duel(world, 60), LoopTiming.Stream(), link, lag).fly(keys(world))
      assertEqualsDouble(kernel.meanLast10s.sum / worlds, scalars.map(_.meanLast10sM).sum / worlds, 0.01)
      assertEqualsDouble(kernel.minDistance.sum / worlds, scalars.map(_.minDistanceM).sum / worlds, 0.01)

  test("a world's result depends on its key and parameters alone, not on its lane or its neighbours"):
    val kernel   = fly(DelayTable.vpn, 60)
    val before   = kernel.meanLast10s.clone
    val reversed = StreamDuelKernel(Duel.paper, LoopTiming.Stream(), DelayTable.vpn, lag)
    reversed.fly(keys.reverse, turnRates.reverse, radii.reverse)
    assertEquals(reversed.meanLast10s.reverse.toSeq, before.toSeq)
