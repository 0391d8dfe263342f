package skein.lanes

import skein.forward.{
  DelayTable,
  Duel,
  LoopTiming,
  Reduced,
  ReducedResponse,
  Rollout,
  VelocityResponse,
  VelocityResponses
}
import skein.optimise.LatencyBudget
import skein.policy.{PaperEvader, PaperPursuer}
import skein.simd.WorldRandom
import skein.vehicle.ReducedModel

class LoopDuelKernelSimulation extends munit.FunSuite:
  private val worlds = DuelKernel.WORLDS
  private val lag    = Reduced(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val models = Seq[(String, VelocityResponse)](
    "lag"           -> lag,
    "no lag"        -> VelocityResponses.Ideal,
    "drag"          -> ReducedResponse(ReducedModel.AirSim),
    "drag and turn" -> ReducedResponse(ReducedModel(0.95, 0.9, 0.04, 0.5, 0.02))
  )

  private val keys     = Array.tabulate(worlds)(WorldRandom.key(3, 1, _))
  private val captureM = 3.9f

  // The evader does not start straight ahead, on a threshold of its pursuer.
  private def duel(world: Int, durationS: Double, asideM: Double = 0): Duel = Duel(
    Duel.paper.pursuer.copy(
      policy = PaperPursuer(0.6 + 0.008 * world),
      startY = Duel.paper.pursuer.startY + asideM
    ),
    Duel.paper.evader.copy(policy = PaperEvader(7 + 0.02 * world), startY = 2),
    durationS
  )

  private def fly(
      timing: LoopTiming,
      link: DelayTable,
      durationS: Double,
      model: VelocityResponse,
      keys: Array[Int] = keys
  ): LoopDuelKernel =
    val (pursuers, evaders) = (LanePolicy.of(PaperPursuer()), LanePolicy.of(PaperEvader()))
    for world <- 0 until worlds do
      pursuers.take(world, PaperPursuer(0.6 + 0.008 * world))
      evaders.take(world, PaperEvader(7 + 0.02 * world))
    val vehicles = LaneDynamics.of(model, duel(0, durationS)).fold(fail(_), identity)
    assertEquals(LoopDuelKernel.refusal(timing, link.maxS, vehicles), null)
    val kernel = LoopDuelKernel(duel(0, durationS), timing, vehicles, link.maxS, pursuers, evaders)
    kernel.fly(keys, Array.fill(worlds)(link), captureM)
    kernel

  private val loops = Seq(
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(decideThenPace = true)
  )

  private def wild(meanMs: Double, jitterMs: Double) = DelayTable.of(LatencyBudget.link(meanMs, jitterMs).get)

  private val links = Seq[(String, DelayTable)](
    "none"                        -> DelayTable.none,
    "direct"                      -> DelayTable.direct,
    "vpn"                         -> DelayTable.vpn,
    "110 ms and 60 ms of jitter"  -> wild(110, 60),
    "200 ms and 300 ms of jitter" -> wild(200, 300),
    "300 ms and 300 ms of jitter" -> wild(300, 300)
  )

  /** Whether the world flies as the scalar reference does; if not, a decision must lie at a threshold. */
  private def same(
      kernel: LoopDuelKernel,
      world: Int,
      timing: LoopTiming,
      link: DelayTable,
      model: VelocityResponse,
      durationS: Double
  ): Boolean =
    def scalar(asideM: Double) =
      Rollout(duel(world, durationS, asideM), timing, link, model).fly(keys(world), captureM)
    val reference   = scalar(0)
    val apart       = ScalarWitness.apart(kernel, world, reference)
    def atThreshold = ScalarWitness.isAtThreshold(reference)(scalar)
    assert(apart < 2e-3 || atThreshold, s"world $world: $apart apart, and at no threshold")
    apart < 2e-3

  for
    (vehicles, model) <- models
    timing            <- loops
    (name, link)      <- links
    if vehicles == "lag" || name == "vpn" || name.startsWith("110")
  do
    test(s"$vehicles, $timing over $name: each world flies 5 s as the scalar reference does, to 2 mm"):
      val kernel = fly(timing, link, 5, model)
      val equal  = (0 until worlds by 2).count(same(kernel, _, timing, link, model, 5))
      assert(equal >= 60, s"$equal of ${worlds / 2} at no threshold")

  for (name, timing) <- Seq(
      "every 20 ms"  -> LoopTiming.Futures(0.02),
      "every 20 ms"  -> LoopTiming.Sequential(0.02),
      "every 10 ms"  -> LoopTiming.stream(0.01),
      "every 300 ms" -> LoopTiming.Futures(0.3)
    )
  do
    test(
      s"${timing.productPrefix} $name over vpn: each world flies 12 s as the scalar reference does, to 2 mm"
    ):
      val kernel = fly(timing, DelayTable.vpn, 12, lag)
      val equal  = (0 until worlds by 16).count(same(kernel, _, timing, DelayTable.vpn, lag, 12))
      assert(equal >= 6, s"$equal of 8 at no threshold")

  for timing <- loops do
    test(
      s"$timing: a world's result depends on its key and parameters alone, not on its lane or its neighbours"
    ):
      val link   = wild(150, 150)
      val before = fly(timing, link, 20, lag).meanLast10s.clone
      // The others meet other delays.
      val some   = keys.zipWithIndex.map((key, world) => if world % 3 == 0 then key else key ^ 0x5a5a5a)
      val beside = fly(timing, link, 20, lag, some)
      for world <- 0 until worlds by 3 do
        assertEquals(beside.meanLast10s(world), before(world), s"world $world")
