package skein.lanes

import skein.forward.{
  DelayTable,
  Duel,
  LoopTiming,
  Reduced,
  ReducedResponse,
  VelocityResponse,
  VelocityResponses
}
import skein.optimise.LatencyBudget
import skein.policy.{PaperEvader, PaperPursuer, Policy}
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
  private def duel(world: Int, durationS: Double): Duel = Duel(
    Duel.paper.pursuer.copy(
      policy = PaperPursuer(0.6 + 0.008 * world)
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
    assertEquals(LoopSupport.refusal(timing, 2, link, vehicles), None)
    val loop   = LoopLanes(timing, 2, durationS, link.maxS)
    val kernel = LoopDuelKernel(duel(0, durationS), loop, vehicles, pursuers, evaders, DuelNumber.all)
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

  private def agreement(timing: LoopTiming, link: DelayTable, durationS: Double, model: VelocityResponse) =
    DuelAgreement.alone(duel(0, durationS), timing, model, _ => link, keys(_), captureM)(
      duel(_, durationS).pursuer.policy.asInstanceOf[Policy],
      duel(_, durationS).evader.policy.asInstanceOf[Policy]
    )

  for
    (vehicles, model) <- models
    timing            <- loops
    (name, link)      <- links
    if vehicles == "lag" || name == "vpn" || name.startsWith("110")
  do
    test(
      s"$vehicles, $timing over $name: the scalar reference's " +
        "decisions and flight for 5 s, in each world compared"
    ):
      agreement(timing, link, 5, model).check(name, 0 until worlds by 3)

  for (name, timing) <- Seq(
      "every 20 ms"  -> LoopTiming.Futures(0.02),
      "every 20 ms"  -> LoopTiming.Sequential(0.02),
      "every 10 ms"  -> LoopTiming.stream(0.01),
      "every 300 ms" -> LoopTiming.Futures(0.3)
    )
  do
    test(s"${timing.productPrefix} $name over vpn: the scalar reference's decisions and flight for 12 s"):
      agreement(timing, DelayTable.vpn, 12, lag).check(name, 0 until worlds by 16)

  for timing <- loops do
    test(s"$timing over vpn: the scalar reference's decisions and flight for 60 s, in each world compared"):
      agreement(timing, DelayTable.vpn, 60, lag).check("60 s", 0 until worlds by 11)

    test(
      s"$timing: a world's result depends on its key and parameters alone, not on its lane or its neighbours"
    ):
      val link   = wild(150, 150)
      val before = fly(timing, link, 20, lag)(DuelNumber.MeanLast10s).clone
      // The others meet other delays.
      val some   = keys.zipWithIndex.map((key, world) => if world % 3 == 0 then key else key ^ 0x5a5a5a)
      val beside = fly(timing, link, 20, lag, some)
      for world <- 0 until worlds by 3 do
        assertEquals(beside(DuelNumber.MeanLast10s)(world), before(world), s"world $world")
