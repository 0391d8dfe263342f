package skein.lanes

import skein.forward.{
  DelayTable,
  Delays,
  Pair,
  LinkDelays,
  LoopTiming,
  PlantResponse,
  ScoredRollout,
  Steering,
  VelocityResponse,
  VelocityResponses
}
import skein.identify.Tilting
import skein.lanes.LanePolicies.take
import skein.policy.{PaperEvader, PaperPursuer}
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom
import skein.units.Span
import skein.vehicle.ReducedModel

class TimetableKernelSimulation extends munit.FunSuite:
  private val worlds = PairKernels.WORLDS
  private val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  private val turnRates = Array.tabulate(worlds)(i => 0.6f + 0.008f * i)
  private val radii     = Array.tabulate(worlds)(i => 7f + 0.02f * i)
  private val captureM  = 3.9f

  private def pursuer(world: Int): PaperPursuer = PaperPursuer(turnRates(world))

  private def evader(world: Int): PaperEvader = PaperEvader(radii(world))

  /** The paper's duel with the evader's start moved from straight ahead, where the sign of a rounding error
    * would decide the direction in which the quadrotors' pursuer turns.
    */
  private val paper = Pair.paper.copy(evader = Pair.paper.evader.copy(startY = 2))

  private def duel(world: Int, durationS: Double): Pair =
    Pair(
      paper.pursuer.copy(policy = pursuer(world)),
      paper.evader.copy(policy = evader(world)),
      durationS
    )

  private def fly(
      timing: LoopTiming,
      link: Delays,
      key: Int,
      durationS: Double,
      model: VelocityResponse
  ): PairKernel =
    val (pursuers, evaders) = (LanePolicies.of(PaperPursuer()), LanePolicies.of(PaperEvader()))
    for world <- 0 until worlds do
      pursuers.take(world, pursuer(world))
      evaders.take(world, evader(world))
    PairKernels.shared(
      paper.copy(durationS = durationS),
      timing,
      model,
      Vector(evaders, pursuers),
      link,
      key,
      captureM
    )

  private val loops = TestLoops.unpredicted

  /** The predictive loop, with the best model of the vehicles that SIMD supports. */
  private def predicted(model: VelocityResponse): Option[LoopTiming] =
    Some(LoopTiming.Predictive(predictor = model.predictor)).filter(timing =>
      LaneDynamics.under(timing, model).isRight
    )

  private val links = Seq[(String, Delays)](
    "none"      -> DelayTable.none,
    "direct"    -> DelayTable.direct,
    "vpn"       -> DelayTable.vpn,
    "vpn-mixed" -> LinkDelays.vpnMixed
  )

  // The reduced model meets all links; the others differ from it only in their vehicles.
  private val models = Seq[(String, VelocityResponse, Seq[(String, Delays)])](
    ("lag", lag, links),
    ("drag", PlantResponse(ReducedModel.AirSim), links.filter(_._1 == "vpn")),
    ("drag and turn", PlantResponse(ReducedModel(0.95, 0.9, 0.04, 0.5, 0.02)), links.filter(_._1 == "vpn")),
    ("a plant of other numbers", PlantResponse(Skating(0.4, 1.5)), links.filter(_._1 == "vpn")),
    ("a plant that tilts", PlantResponse(Tilting(0.95, 0.9, 0.2)), links),
    ("quadrotor", VelocityResponses.quadrotor(), links.filter(link => link._1 == "none" || link._1 == "vpn"))
  )

  for
    (vehicles, model, flown) <- models
    timing                   <- loops ++ predicted(model)
    (name, link)             <- flown
  do
    // None of these worlds meets a threshold within 5 s: PairAgreement would name it.
    test(
      s"$vehicles, $timing over $name: candidates agree with the scalar reference, 5 s to 2 mm"
    ):
      var close, all, captures = 0
      for episode <- 0 until 2 do
        val key    = WorldRandom.key(3, 1, episode)
        val kernel = fly(timing, link, key, 5, model)
        for world <- 0 until worlds by 3 do
          val scalar = ScoredRollout(duel(world, 5).engagement, timing, link, model).fly(key, captureM)
          all += 1
          if (kernel(PairNumber.MinDistance)(world) - scalar.minDistanceM).abs < 2e-3 &&
            (kernel(PairNumber.MeanDistance)(world) - scalar.meanDistanceM).abs < 2e-3 &&
            (kernel(PairNumber.PursuerEffort)(world) - scalar.pursuerEffortRad).abs < 2e-3 &&
            (kernel(PairNumber.EvaderEffort)(world) - scalar.evaderEffortRad).abs < 2e-3
          then close += 1
          if kernel(PairNumber.Capture)(world) == scalar.captureS.toFloat then captures += 1
      assert(close == all, s"$close of $all worlds agree")
      assert(captures == all, s"$captures of $all captures agree")

    // Long flights of one loop: the others differ only in their timetables.
    if timing == LoopTiming.Stream() then
      test(s"$vehicles, $timing over $name: compared worlds have equal decisions and captures for 60 s"):
        agreement(timing, link, WorldRandom.key(4, 1, 0), 60, model).check(name, 0 until worlds by 6)

  for timing <- Seq(
      LoopTiming.Futures(steering = Steering(mostOutstanding = 6)),
      LoopTiming.Stream(steering = Steering(mostOutstanding = 6)),
      LoopTiming.Predictive(predictor = lag.predictor, steering = Steering(mostOutstanding = 6))
    )
  do
    test(
      s"$timing over a round trip of 400 ms: compared worlds have equal decisions and captures for 10 s"
    ):
      val far = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(400)))
      agreement(timing, far, WorldRandom.key(6, 1, 0), 10, lag).check("far", 0 until worlds by 6)

  test("with a period that does not divide 10 s, results are those of the scalar reference"):
    agreement(LoopTiming.stream(0.3), DelayTable.direct, WorldRandom.key(5, 1, 0), 12, lag)
      .check("every 0.3 s", 0 until worlds by 4)

  private def agreement(
      timing: LoopTiming,
      link: Delays,
      key: Int,
      durationS: Double,
      model: VelocityResponse
  ): PairAgreement =
    PairAgreement.shared(paper.copy(durationS = durationS), timing, model, link, key, captureM)(
      pursuer,
      evader
    )
