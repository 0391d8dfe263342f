package skein.forward

import skein.fusion.{Exposure, SensorModel}
import skein.lanes.{PairBatch, PairWorlds}
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.signal.{LatencyDistribution, SplitMix64}
import skein.simd.WorldRandom
import skein.units.*
import skein.vehicle.ReducedModel

/** Pursuers whose only knowledge of their evaders is a sensor's model. */
class SensedOpponentSuite extends munit.FunSuite:
  private val exact = SensorModel(
    everyS = 0.02,
    fovRad = 3.1,
    farthestM = 1000,
    detection = 1,
    bearingSdRad = 1e-6,
    rangeBias = 1,
    rangeSd = 1e-6,
    takes = LatencyDistribution.Constant(Span.Zero)
  )
  private val camera = GuideCamera.model

  private def duel(eye: Option[SensorModel]) =
    val paper = Pair.paper
    paper.copy(pursuer = paper.pursuer.copy(eye = eye))

  private def flown(
      eye: Option[SensorModel],
      timing: LoopTiming,
      link: Delays = DelayTable.none,
      seed: Int = 1
  ) =
    ScoredRollout(
      duel(eye).engagement,
      timing,
      link,
      PlantResponse(ReducedModel.AirSimLag)
    ).fly(WorldRandom.key(seed, 0, 0))

  private def last10s(eye: Option[SensorModel], timing: LoopTiming, link: Delays) =
    (1 to 12).map(flown(eye, timing, link, _).meanLast10sM).sum / 12

  private val predictive = LoopTiming.Predictive(predictor = PlantResponse(ReducedModel.AirSimLag).predictor)

  for timing <- Seq(LoopTiming.Paused(), LoopTiming.stream(0.1), predictive) do
    test(
      s"${timing.productPrefix}: an exact sensor without delay gives the flight of a policy with readings"
    ):
      val told = flown(None, timing)
      val seen = flown(Some(exact), timing)
      assertEqualsDouble(seen.meanLast10sM, told.meanLast10sM, 0.05 * told.meanLast10sM)
      assertEquals(seen, flown(Some(exact), timing))

  test("an evader out of view, too far or undetected is not found; errors are as wide as configured"):
    val random                                                       = SplitMix64(3)
    val own                                                          = Vector3(3, -2, -20)
    def seen(model: SensorModel, azimuthRad: Double, rangeM: Double) = model.measured(
      Instant.Epoch,
      Exposure(
        0.4,
        own,
        own + Vector3(StrictMath.cos(0.4 + azimuthRad), StrictMath.sin(0.4 + azimuthRad), 0) * rangeM,
        random.nextDouble(),
        random.nextDouble(),
        random.nextDouble()
      )
    )
    assertEquals(seen(exact.copy(fovRad = 1), 0.51, 10), None)
    assert(seen(exact.copy(fovRad = 1), 0.49, 10).isDefined)
    assertEquals(seen(exact.copy(farthestM = 9), 0, 10), None)
    val model = camera.copy(detection = 0.7, bearingSdRad = 0.01, rangeBias = 1.1, rangeSd = 0.05)
    val found = Vector.fill(4000)(seen(model, 0.2, 10)).flatten
    assertEqualsDouble(found.size / 4000.0, 0.7, 0.03)
    val polar = found.map: measured =>
      val way = measured.positionNed - own
      (math.IEEEremainder(StrictMath.atan2(way.y, way.x) - 0.6, 2 * math.Pi), way.norm)
    def spread(values: Vector[Double]) =
      val mean = values.sum / values.size
      (mean, math.sqrt(values.map(value => (value - mean) * (value - mean)).sum / values.size))
    val ((bearing, bearingSd), (range, rangeSd)) = (spread(polar.map(_._1)), spread(polar.map(_._2)))
    assertEqualsDouble(bearing, 0, 0.001)
    assertEqualsDouble(bearingSd, 0.01, 0.0005)
    assertEqualsDouble(range, 11, 0.04)
    assertEqualsDouble(rangeSd, 0.55, 0.03)

  test("a camera costs distance, more with slower recognition, and most if every result is too late"):
    val stream = LoopTiming.stream(0.1)
    val told   = last10s(None, stream, DelayTable.direct)
    val sees   = last10s(Some(camera), stream, DelayTable.direct)
    val slowly =
      last10s(
        Some(camera.copy(takes = LatencyDistribution.Constant(Span.ofMillis(290)))),
        stream,
        DelayTable.direct
      )
    assert(clue(told) < clue(sees) && sees < clue(slowly))
    // Late results are not used: only the start is ever known.
    val never = last10s(Some(camera.copy(deadlineS = 0.01)), stream, DelayTable.direct)
    assert(clue(never) > slowly)

  private val (pursuer, evader) = (PaperPursuer(), PaperEvader())

  for timing <- Seq(LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.stream(0.1), predictive) do
    test(
      s"${timing.productPrefix}: worlds with separate delays have equal results with SIMD and the scalar engine"
    ):
      // To the side of the pursuer's way, so that rounding does not decide the side of any turn.
      val seeing = duel(Some(camera))
      val beside = seeing.copy(evader = seeing.evader.copy(startY = 2), durationS = 12)
      val batch  = PairBatch(beside, timing, PlantResponse(ReducedModel.AirSimLag), threads = 1)
      val engine = batch.engine(pursuer, evader, shareEpisodes = false, Seq(DelayTable.vpn)).text
      assert(engine.startsWith("SIMD, "), engine)
      val worlds = new PairWorlds:
        def size: Int                   = 40
        def key(world: Int): Int        = WorldRandom.key(world, 0, 0)
        def link(world: Int): Delays    = DelayTable.vpn
        def pursuer(world: Int): Policy = SensedOpponentSuite.this.pursuer
        def evader(world: Int): Policy  = SensedOpponentSuite.this.evader
      val outcomes = batch.fly(worlds)
      val rollout  =
        ScoredRollout(beside.engagement, timing, DelayTable.vpn, PlantResponse(ReducedModel.AirSimLag))
      for world <- 0 until worlds.size by 7 do
        val alone = rollout.fly(worlds.key(world))
        assertEqualsDouble(outcomes.meanLast10sM(world), alone.meanLast10sM, 5e-3, s"world $world")

  test("eyes that SIMD does not support use the scalar engine, and the engine's text states it"):
    def told(duel: Pair, model: VelocityResponse) =
      PairBatch(duel, predictive, model, threads = 1)
        .engine(pursuer, evader, shareEpisodes = false, Seq(DelayTable.vpn)).text
    val seeing = duel(Some(camera))
    val both   = told(
      seeing.copy(evader = seeing.evader.copy(eye = Some(camera))),
      PlantResponse(ReducedModel.AirSimLag)
    )
    assertEquals(
      both,
      "scalar: two vehicles that see each other by sensors use SIMD only if candidates share episodes"
    )
    assertEquals(
      told(seeing, VelocityResponses.quadrotor()),
      "scalar: quadrotors with a sensor use SIMD only if candidates share episodes"
    )

  test("a sensor with errors too small for floats uses the scalar engine"):
    val batch  = PairBatch(duel(Some(exact)), predictive, PlantResponse(ReducedModel.AirSimLag), threads = 1)
    val engine = batch.engine(pursuer, evader, shareEpisodes = true, Seq(DelayTable.vpn)).text
    assert(engine.startsWith("scalar: SIMD supports sensors with deviations of"), engine)
