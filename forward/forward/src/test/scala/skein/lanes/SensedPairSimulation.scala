package skein.lanes

import skein.forward.*
import skein.identify.Tilting
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.vehicle.{ReducedModel, SensorNoise}

/** The two engines' decisions and flights of duels by readings with errors. */
class SensedPairSimulation extends munit.FunSuite:
  private val worlds = PairKernels.WORLDS
  private val keys   = Array.tabulate(worlds)(WorldRandom.key(3, 1, _))
  private val models = Seq[(String, VelocityResponse)](
    "lag"     -> VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05),
    "drag"    -> PlantResponse(ReducedModel.AirSim),
    "tilting" -> PlantResponse(Tilting(0.95, 0.9, 0.2, 0.05))
  )
  private val duel                        = Pair.paper.copy(evader = Pair.paper.evader.copy(startY = 2))
  private def pursuer(world: Int): Policy = AgeAwarePursuer(8, 0.01 * world, 1)
  private def evader(world: Int): Policy  = PaperEvader(7 + 0.02 * world)
  private def sensed(of: VelocityResponse, text: String) =
    SensedResponse(of, SensorNoise.parse(text).fold(fail(_), identity))

  private def loops(model: VelocityResponse) = Seq(
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Stream(decideThenPace = true),
    LoopTiming.Stream(0.04),
    LoopTiming.Predictive(predictor = model.predictor)
  )

  for
    (vehicles, model) <- models
    timing            <- loops(model)
    text              <- Seq(
      "position=0.3,velocity=0.1,drift=1.5/20s",
      "dropout=5%",
      "position=0.2,velocity=0.05,dropout=20%,outage=1s/4s"
    )
    if vehicles == "lag" || text.contains("outage") && timing.periodS == 0.1
  do
    test(s"$vehicles, $timing, $text: the scalar reference's decisions and flight for 4 s"):
      val flown = duel.copy(durationS = 4)
      PairAgreement
        .alone(flown, timing, sensed(model, text), _ => DelayTable.vpn, keys(_))(pursuer, evader)
        .check("own delays", 0 until worlds by 12)
      if text.contains("outage") then
        PairAgreement
          .shared(flown, timing, sensed(model, text), DelayTable.vpn, keys(0))(pursuer, evader)
          .check("shared delays", 0 until worlds by 25)

  for timing <- loops(models.head._2) do
    test(s"$timing, long outages: the scalar reference's decisions and flight for 25 s"):
      // A forecast of the scalar engine keeps the last 64 commands.
      val outage = if timing.isInstanceOf[LoopTiming.Predictive] then "2s/9s" else "5s/20s"
      val model  = sensed(models.head._2, s"position=0.3,dropout=10%,outage=$outage")
      PairAgreement
        .alone(duel.copy(durationS = 25), timing, model, _ => DelayTable.vpn, keys(_))(pursuer, evader)
        .check("own delays", 0 until worlds by 20)

  for timing <- loops(models.head._2); shared <- Seq(true, false) do
    test(s"$timing, ${if shared then "shared" else "own"} delays, with a camera too: images show the truth"):
      val seeing = duel.copy(pursuer = duel.pursuer.copy(eye = Some(GuideCamera.model)), durationS = 4)
      agree(seeing, timing, sensed(models.head._2, "position=0.3,drift=1/9s,dropout=5%"), shared): Unit

  test("paused: worlds have errors of their own, those of the scalar reference"):
    for (vehicles, model) <- models; shared <- Seq(true, false) do
      val noisy = sensed(model, "position=0.3,velocity=0.1,drift=1/9s,dropout=50%")
      val flown = agree(duel.copy(durationS = 5), LoopTiming.Paused(), noisy, shared)
      assertEquals(flown.distinct.length, if shared then 1 else flown.length, vehicles)

  /** Mean distances of worlds of one candidate, which are those of the scalar reference. */
  private def agree(duel: Pair, timing: LoopTiming, model: VelocityResponse, shared: Boolean): Array[Float] =
    val all = new PairWorlds:
      def size: Int                       = 12
      override def shareEpisodes: Boolean = shared
      def key(world: Int): Int            = keys(if shared then 0 else world)
      def link(world: Int): Delays        = DelayTable.vpn
      def pursuer(world: Int): Policy     = PaperPursuer(0.6)
      def evader(world: Int): Policy      = PaperEvader(7)
    def flown(isReference: Boolean) =
      val batch  = PairBatch(duel, timing, model, threads = 1, isReference = isReference)
      val engine = batch.engine(all.pursuer(0), all.evader(0), shared, Seq(DelayTable.vpn))
      assertEquals(engine.fliesByLanes, !isReference, engine.text)
      batch.fly(all).meanDistanceM
    val (fast, slow) = (flown(false), flown(true))
    for world <- fast.indices do assertEqualsDouble(fast(world).toDouble, slow(world), 5e-3, s"world $world")
    fast
