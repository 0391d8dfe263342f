package skein.lanes

import skein.forward.{
  AlternatingDelays,
  Asking,
  DelayTable,
  Pair,
  LoopTiming,
  LossyDelays,
  PlantResponse,
  Steering,
  TabledDelays,
  VelocityResponse,
  VelocityResponses
}
import skein.identify.Tilting
import skein.lanes.LanePolicies.take
import skein.optimise.LatencyBudget
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.port.Moves
import skein.signal.Impairment
import skein.simd.WorldRandom
import skein.testing.Lengthy
import skein.units.Span
import skein.vehicle.{ConstantVelocity, ReducedModel}

/** The two engines' flights of duels in which every world has delays of its own. */
abstract class LoopPairAgreement(isDaily: Boolean) extends munit.FunSuite:
  protected val worlds = PairKernels.WORLDS
  protected val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  protected val models = Seq[(String, VelocityResponse)](
    "lag"           -> lag,
    "no lag"        -> VelocityResponses.Ideal,
    "drag"          -> PlantResponse(ReducedModel.AirSim),
    "drag and turn" -> PlantResponse(ReducedModel(0.95, 0.9, 0.04, 0.5, 0.02)),
    "skating"       -> PlantResponse(Skating(0.4, 1.5, 0.01)),
    "tilting"       -> PlantResponse(Tilting(0.95, 0.9, 0.2, 0.05))
  )

  protected val keys     = Array.tabulate(worlds)(WorldRandom.key(3, 1, _))
  protected val captureM = 3.9f

  // The evader does not start straight ahead, on a threshold of its pursuer.
  protected def duel(world: Int, durationS: Double): Pair = Pair(
    Pair.paper.pursuer.copy(
      policy = PaperPursuer(0.6 + 0.008 * world)
    ),
    Pair.paper.evader.copy(policy = PaperEvader(7 + 0.02 * world), startY = 2),
    durationS
  )

  protected def fly(
      timing: LoopTiming,
      link: TabledDelays,
      durationS: Double,
      model: VelocityResponse,
      keys: Array[Int] = keys
  ): PairKernel =
    val (pursuers, evaders) = (LanePolicies.of(PaperPursuer()), LanePolicies.of(PaperEvader()))
    for world <- 0 until worlds do
      pursuers.take(world, PaperPursuer(0.6 + 0.008 * world))
      evaders.take(world, PaperEvader(7 + 0.02 * world))
    PairKernels.alone(
      duel(0, durationS),
      timing,
      model,
      Vector(evaders, pursuers),
      Array.fill(worlds)(link),
      keys,
      captureM
    )

  protected def loops(model: VelocityResponse) = Seq(
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(decideThenPace = true),
    LoopTiming.Predictive(predictor = model.predictor)
  )

  protected def wild(meanMs: Double, jitterMs: Double) =
    DelayTable.of(LatencyBudget.link(meanMs, jitterMs).get)

  /** A link that is busy for about a second, and quiet for half of one. */
  protected val changing = AlternatingDelays(wild(200, 300), DelayTable.direct, 1.0, 0.5)

  /** Bursts, and outages of 0.4 s, over a link that changes. */
  protected val impaired = LossyDelays.of(
    AlternatingDelays(DelayTable.vpn, DelayTable.direct, 0.5, 0.8),
    Seq(Impairment.Loss(0.05, 4), Impairment.Outage(Span.ofMillis(400), Span.ofSeconds(2))),
    timeoutS = 0.237,
    packetsPerS = 40
  )

  protected val links = Seq[(String, TabledDelays)](
    "none"                        -> DelayTable.none,
    "direct"                      -> DelayTable.direct,
    "vpn"                         -> DelayTable.vpn,
    "110 ms and 60 ms of jitter"  -> wild(110, 60),
    "200 ms and 300 ms of jitter" -> wild(200, 300),
    "300 ms and 300 ms of jitter" -> wild(300, 300),
    "110 ms and a busy link"      -> AlternatingDelays(wild(110, 60), wild(300, 300), 0.5, 0.8),
    "one that changes"            -> changing,
    "vpn with losses"             ->
      LossyDelays.of(DelayTable.vpn, Seq(Impairment.independent(0.05)), timeoutS = 0.303, packetsPerS = 40),
    "one with bursts and outages" -> impaired
  )

  protected def agreement(
      timing: LoopTiming,
      link: TabledDelays,
      durationS: Double,
      model: VelocityResponse
  ) =
    unseen(timing, link, durationS, model)(duel(_, durationS).pursuer.policy.asInstanceOf[Policy])

  protected def unseen(timing: LoopTiming, link: TabledDelays, durationS: Double, model: VelocityResponse)(
      pursuer: Int => Policy
  ) =
    PairAgreement.alone(duel(0, durationS), timing, model, _ => link, keys(_), captureM)(
      pursuer,
      duel(_, durationS).evader.policy.asInstanceOf[Policy]
    )

  for
    (vehicles, model) <- models
    timing            <- loops(model)
    (name, link)      <- links
    if vehicles == "lag" || name == "vpn" || name.startsWith("110")
    if isDaily == (name == "vpn" || vehicles == "lag" && !name.startsWith("300"))
  do
    test(
      s"$vehicles, $timing over $name: the scalar reference's " +
        "decisions and flight for 5 s, in each world compared"
    ):
      agreement(timing, link, 5, model).check(name, 0 until worlds by 3)

  for
    most <- Seq(3, 6)
    steering = Steering(mostOutstanding = most)
    (vehicles, model) <- models.filter((name, _) => name == "lag" || name == "drag")
    timing            <- Seq(
      LoopTiming.Sequential(steering = steering),
      LoopTiming.Futures(steering = steering),
      LoopTiming.Stream(steering = steering),
      LoopTiming.Stream(0.04, steering = steering),
      LoopTiming.Predictive(predictor = model.predictor, steering = steering)
    )
    (name, link) <-
      links.filter((name, _) => name == "vpn" || name.startsWith("300") || name.startsWith("one "))
    if isDaily == (most == 3 && vehicles == "lag")
  do
    test(
      s"$vehicles, $timing over $name with $most moves in flight: the scalar reference's decisions and flight"
    ):
      agreement(timing, link, 5, model).check(name, 0 until worlds by 3)

  for
    (vehicles, model) <- models.filter((name, _) => name == "lag" || name == "drag")
    (name, link)      <- links.filter((name, _) => name.startsWith("300"))
    if isDaily == (vehicles == "lag")
  do
    test(s"$vehicles over $name, with as many moves in flight as may be: the scalar reference's flight"):
      val most = Steering(mostOutstanding = Moves.MostInFlight)
      agreement(LoopTiming.Stream(0.02, steering = most), link, 5, model).check(name, 0 until worlds by 3)

/** Each vehicle over one link, one vehicle over most links, and cases that are not combinations. */
class LoopPairSimulation extends LoopPairAgreement(isDaily = true):
  private val unseenPursuers = Seq[(String, Int => Policy)](
    "remembers"                    -> (world => TrendPursuer(2 + 0.02 * world, 0.5, 1)),
    "asks for velocities and ages" -> (world => AgeAwarePursuer(8, 0.01 * world, 1))
  )

  for
    (does, pursuer)   <- unseenPursuers
    (vehicles, model) <- models
    predictor         <- Seq(model.predictor, ConstantVelocity)
    if predictor != ConstantVelocity || vehicles == "drag"
  do
    test(
      s"$vehicles predicted by $predictor, beside a pursuer that $does: the scalar reference's decisions and flight"
    ):
      unseen(
        LoopTiming.Predictive(predictor = predictor),
        DelayTable.vpn,
        6,
        model
      )(pursuer).check(does, 0 until worlds by 9)

  test(
    "predictive every 10 ms over a constant link: of events in one moment the first scheduled is the first"
  ):
    for link <- Seq(DelayTable.none, wild(20, 0), wild(45, 0)) do
      agreement(
        LoopTiming.Predictive(0.01, lag.predictor),
        link,
        5,
        lag
      ).check(s"${link.maxS} s", 0 until worlds by 16)

  private val slow = VelocityResponses.lag(gain = 0.95, lagS = 0.8, deadTimeS = 0.3)

  for (what, timing, link, model) <- Seq(
      (
        "that asks one question at a time",
        LoopTiming.Predictive(0.1, lag.predictor, Asking(window = 1)),
        wild(110, 60),
        lag
      ),
      (
        "most of whose questions fail",
        LoopTiming.Predictive(0.1, lag.predictor, Asking(timeoutS = 0.3)),
        wild(370, 115),
        lag
      ),
      (
        "that may command in the moment in which it is due",
        LoopTiming.Predictive(0.04, lag.predictor, steering = Steering(minIntervalS = 0.05)),
        wild(27, 14),
        lag
      ),
      (
        "of vehicles with a long dead time",
        LoopTiming.Predictive(0.04, slow.predictor),
        wild(45, 60),
        slow
      )
    )
  do
    test(s"a predictive loop $what: the scalar reference's decisions and flight for 10 s"):
      agreement(timing, link, 10, model).check(what, 0 until worlds by 3)

  test("predictive over a constant link whose answers arrive when decisions are due"):
    for meanMs <- Seq(50, 100, 150, 350, 450) do
      agreement(
        LoopTiming.Predictive(0.1, lag.predictor),
        wild(meanMs, 0),
        5,
        lag
      ).check(s"$meanMs ms", 0 until worlds by 16)

  for (name, timing) <- Seq(
      "every 20 ms"  -> LoopTiming.Futures(0.02),
      "every 20 ms"  -> LoopTiming.Sequential(0.02),
      "every 10 ms"  -> LoopTiming.stream(0.01),
      "every 300 ms" -> LoopTiming.Futures(0.3),
      "every 10 ms"  -> LoopTiming.Predictive(0.01, lag.predictor),
      "every 20 ms"  -> LoopTiming.Predictive(0.02, lag.predictor),
      "every 300 ms" -> LoopTiming.Predictive(0.3, lag.predictor)
    )
  do
    test(s"${timing.productPrefix} $name over vpn: the scalar reference's decisions and flight for 12 s"):
      agreement(timing, DelayTable.vpn, 12, lag).check(name, 0 until worlds by 16)

  for periodS <- Seq(0.01, 0.004) do
    test(
      s"stream every $periodS s, where requests fail after many later ones: the scalar reference's decisions"
    ):
      val timing = LoopTiming.Stream(periodS, periodS / 2, periodS, asking = Asking(window = 16))
      agreement(timing, wild(40, 200), 5, lag).check("slow", 0 until worlds by 9)

  test(
    "predictive, with one period of dead time and a link with high jitter: worlds turn at different times"
  ):
    val late   = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.1)
    val timing = LoopTiming.Predictive(0.1, late.predictor)
    for (jitterMs, episode) <- Seq(150.0, 300.0).zipWithIndex do
      fly(timing, wild(200, jitterMs), 60, late, Array.tabulate(worlds)(WorldRandom.key(4, episode, _))): Unit
      agreement(timing, wild(200, jitterMs), 10, late).check("late", 0 until worlds by 9)

  for timing <- loops(lag) do
    test(s"$timing over vpn: the scalar reference's decisions and flight for 60 s, in each world compared"):
      agreement(timing, DelayTable.vpn, 60, lag).check("60 s", 0 until worlds by 11)

    test(
      s"$timing: a world's result depends only on its key and parameters, not on its lane or its neighbours"
    ):
      for link <- Seq(wild(150, 150), changing) do
        val before = fly(timing, link, 20, lag)(PairNumber.MeanLast10s).clone
        // The others meet other delays.
        val some   = keys.zipWithIndex.map((key, world) => if world % 3 == 0 then key else key ^ 0x5a5a5a)
        val beside = fly(timing, link, 20, lag, some)
        for world <- 0 until worlds by 3 do
          assertEquals(beside(PairNumber.MeanLast10s)(world), before(world), s"world $world")

/** The other combinations. */
class LoopPairCombinationsSimulation extends LoopPairAgreement(isDaily = false), Lengthy
