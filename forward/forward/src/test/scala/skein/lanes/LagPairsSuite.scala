package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.forward.{
  DelayTable,
  Pair,
  EpisodeOutcome,
  LoopTiming,
  ScoredRollout,
  TabledDelays,
  VelocityResponse,
  VelocityResponses
}
import skein.lanes.LanePolicies.take
import skein.optimise.LatencyBudget
import skein.policy.{PaperEvader, PaperPursuer}
import skein.simd.WorldRandom

/** Duels under `stream` with a first-order lag, which has its own implementation
  * ([[skein.lanes.loop.LagVehicles]]).
  */
class LagPairsSuite extends munit.FunSuite:
  private val worlds = PairKernels.WORLDS
  private val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  private val keys      = Array.tabulate(worlds)(WorldRandom.key(3, 1, _))
  private val turnRates = Array.tabulate(worlds)(i => 0.6f + 0.008f * i)
  private val radii     = Array.tabulate(worlds)(i => 7f + 0.02f * i)

  private val captureRadiusM = 3.9f

  private def duel(world: Int, durationS: Double): Pair = Pair(
    Pair.paper.pursuer.copy(policy = PaperPursuer(turnRates(world))),
    Pair.paper.evader.copy(policy = PaperEvader(radii(world))),
    durationS
  )

  private def flown(
      links: Array[TabledDelays],
      durationS: Double = 60,
      shortCut: Boolean = true,
      order: Array[Int] = Array.range(0, worlds)
  ): PairKernel =
    val (pursuers, evaders) = (LanePolicies.of(PaperPursuer()), LanePolicies.of(PaperEvader()))
    for (of, world) <- order.zipWithIndex do
      pursuers.take(world, PaperPursuer(turnRates(of)))
      evaders.take(world, PaperEvader(radii(of)))
    PairKernels.alone(
      Pair.paper.copy(durationS = durationS),
      LoopTiming.Stream(),
      lag,
      Vector(evaders, pursuers),
      links,
      order.map(keys),
      captureRadiusM,
      shortCut = shortCut
    )

  private def over(link: DelayTable) = Array.fill[TabledDelays](worlds)(link)

  private val some = 0 until worlds by 3

  private def agreement(link: DelayTable, durationS: Double, periodS: Double = 0.1): PairAgreement =
    PairAgreement.alone(
      Pair.paper.copy(durationS = durationS),
      LoopTiming.stream(periodS),
      lag,
      _ => link,
      keys(_),
      captureRadiusM
    )(world => PaperPursuer(turnRates(world)), world => PaperEvader(radii(world)))

  private def vehicles(model: VelocityResponse): LaneDynamics =
    LaneDynamics.of(model).fold(fail(_), identity)

  private def fly(link: DelayTable, durationS: Double): PairKernel = flown(over(link), durationS)

  for (name, link) <- Seq("none" -> DelayTable.none, "direct" -> DelayTable.direct, "vpn" -> DelayTable.vpn)
  do
    test(s"over $name kernel and scalar reference agree for 5 s, to 2 mm in every world"):
      val kernel = fly(link, 5)
      val equal  = (0 until worlds).count: world =>
        val scalar =
          ScoredRollout(duel(world, 5).engagement, LoopTiming.Stream(), link, lag).fly(
            keys(world),
            captureRadiusM
          )
        (kernel(PairNumber.MinDistance)(world) - scalar.minDistanceM).abs < 2e-3 &&
        (kernel(PairNumber.MeanDistance)(world) - scalar.meanDistanceM).abs < 2e-3 &&
        (kernel(PairNumber.PursuerEffort)(world) - scalar.pursuerEffortRad).abs < 2e-3 &&
        (kernel(PairNumber.EvaderEffort)(world) - scalar.evaderEffortRad).abs < 2e-3
      assert(equal == worlds, s"$equal of $worlds worlds agree")

    test(s"over $name kernel and scalar reference agree on the mean of 60 s to 1 cm"):
      val kernel  = fly(link, 60)
      val scalars = ArrayBuffer.empty[EpisodeOutcome]
      for world <- 0 until worlds do
        scalars += ScoredRollout(
          duel(world, 60).engagement,
          LoopTiming.Stream(),
          link,
          lag
        ).fly(keys(world), captureRadiusM)
      assertEqualsDouble(
        kernel(PairNumber.MeanLast10s).sum / worlds,
        scalars.map(_.meanLast10sM).sum / worlds,
        0.01
      )
      assertEqualsDouble(
        kernel(PairNumber.MinDistance).sum / worlds,
        scalars.map(_.minDistanceM).sum / worlds,
        0.01
      )
      assertEqualsDouble(
        kernel(PairNumber.PursuerEffort).sum / worlds,
        scalars.map(_.pursuerEffortRad).sum / worlds,
        0.05
      )
      val captured = scalars.count(_.captureS.isFinite)
      assert(captured > worlds / 10 && captured < worlds, s"$captured captured")

    test(s"over $name compared worlds have the decisions and captures of the scalar reference for 60 s"):
      agreement(link, 60).check(s"over $name", some)

  test(
    "with a period that does not divide 10 s, the mean of the last scores equals that of the scalar reference"
  ):
    agreement(DelayTable.direct, 12, periodS = 0.3).check("every 0.3 s", some)

  private val badLinks = Seq((110.0, 60.0), (215.0, 36.0), (150.0, 150.0), (200.0, 300.0), (300.0, 300.0))

  // There answers overtake one another, requests fail, and vehicles answer in turns.
  for (meanMs, jitterMs) <- badLinks do
    val link = DelayTable.of(LatencyBudget.link(meanMs, jitterMs).get)

    test(s"at $meanMs ms and $jitterMs ms of jitter kernel and scalar reference agree for 10 s"):
      assertEquals(
        LoopSupport.refusal(LoopTiming.stream(0.1), Vector.fill(2)(vehicles(lag)), link),
        None,
        s"up to ${link.maxS} s"
      )
      agreement(link, 10).check(s"$meanMs ms and $jitterMs ms of jitter", some)

    test(s"at $meanMs ms and $jitterMs ms of jitter views with SIMD equal those computed one by one"):
      val kernel  = flown(over(link))
      val longWay = flown(over(link), shortCut = false)
      assertEquals(kernel(PairNumber.MeanLast10s).toSeq, longWay(PairNumber.MeanLast10s).toSeq)
      assertEquals(kernel(PairNumber.PursuerEffort).toSeq, longWay(PairNumber.PursuerEffort).toSeq)

  test("a world's result depends only on its key and parameters, not on its lane or its neighbours"):
    val kernel   = fly(DelayTable.vpn, 60)
    val before   = kernel(PairNumber.MeanLast10s).clone
    val reversed = flown(over(DelayTable.vpn), order = Array.range(0, worlds).reverse)
    assertEquals(reversed(PairNumber.MeanLast10s).reverse.toSeq, before.toSeq)

  test("worlds with different links have the results that they have alone"):
    val links  = Vector(DelayTable.none, DelayTable.direct, DelayTable.vpn)
    val kernel = flown(Array.tabulate[TabledDelays](worlds)(i => links(i / 5 % 3)))
    val alone  = links.map(link => fly(link, 60))
    for world <- 0 until worlds do
      assertEquals(
        kernel(PairNumber.MeanLast10s)(world),
        alone(world / 5 % 3)(PairNumber.MeanLast10s)(world),
        s"world $world"
      )
