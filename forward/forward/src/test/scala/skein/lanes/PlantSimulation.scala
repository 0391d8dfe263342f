package skein.lanes

import skein.forward.*
import skein.lanes.plant.{PlantLanes, PlantStages}
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.testing.Unhurried
import skein.vehicle.{DrivenCar, PlaneReading, Plant, ReducedModel}

/** Vehicles of a user's own, compiled as they are written. */
class PlantSimulation extends munit.FunSuite, Unhurried:
  private val bicycle =
    PlantResponse(Bicycle(wheelbaseM = 1.2, steeringLagS = 0.3, mostMps2 = 4, antennaM = 0.4))
  private val short = Pair.paper.copy(
    evader = Pair.paper.evader.copy(startY = 2), // straight ahead a rounding error would decide where to turn
    durationS = 6
  )

  private def worlds(shared: Boolean): PairWorlds = new PairWorlds:
    def size: Int                       = 256
    override def shareEpisodes: Boolean = shared
    def key(world: Int): Int            = WorldRandom.key(5, 0, world / 128)
    def link(world: Int): Delays        = DelayTable.vpn
    def pursuer(world: Int): Policy     = PaperPursuer(0.6 + 0.004 * (world % 128))
    def evader(world: Int): Policy      = PaperEvader(7 + 0.01 * (world % 128))

  private val train = PlantResponse(Train(lagS = 0.6))

  for
    timing <-
      Seq(LoopTiming.Paused(), LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.Stream())
    (name, vehicle) <-
      Seq(
        "a bicycle"                          -> bicycle,
        "a car with tyre lag and its driver" -> PlantResponse(DrivenCar()),
        "a train"                            -> train
      )
  do
    test(s"$name with SIMD under ${timing.productPrefix} equals its scalar simulation"):
      val batch = PairBatch(short, timing, vehicle, threads = 1)
      assert(batch.engine(PaperPursuer(), PaperEvader(), shareEpisodes = true, Seq(DelayTable.vpn)).isFast)
      val all   = worlds(shared = true)
      val flown = batch.fly(all)
      val off   = (0 until all.size by 3).map(offM(all, flown, timing, vehicle, _))
      assert(off.max < 1e-3, off.sorted.takeRight(5))

  private def offM(
      all: PairWorlds,
      flown: PairOutcomes,
      timing: LoopTiming,
      vehicle: VelocityResponse,
      world: Int
  ): Double =
    val duel = Pair(
      short.pursuer.copy(policy = all.pursuer(world)),
      short.evader.copy(policy = all.evader(world)),
      short.durationS
    )
    val scalar = ScoredRollout(duel.engagement, timing, all.link(world), vehicle).fly(all.key(world))
    (flown.meanDistanceM(world) - scalar.meanDistanceM).abs max
      (flown.minDistanceM(world) - scalar.minDistanceM).abs

  for
    timing          <- Seq(LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.Stream())
    (name, vehicle) <-
      Seq(
        "a bicycle"                          -> bicycle,
        "a car with tyre lag and its driver" -> PlantResponse(DrivenCar()),
        "a train"                            -> train
      )
  do
    test(s"$name with SIMD under ${timing.productPrefix} with separate delays equals its scalar simulation"):
      val batch = PairBatch(short, timing, vehicle, threads = 1)
      val all   = new PairWorlds:
        def size: Int                   = 256
        def key(world: Int): Int        = WorldRandom.key(5, 1, world)
        def link(world: Int): Delays    = if world % 2 == 0 then DelayTable.vpn else DelayTable.direct
        def pursuer(world: Int): Policy = PaperPursuer(0.6 + 0.002 * world)
        def evader(world: Int): Policy  = PaperEvader(7 + 0.005 * world)
      assert(batch.engine(PaperPursuer(), PaperEvader(), shareEpisodes = false, Seq(DelayTable.vpn)).isFast)
      val flown = batch.fly(all)
      val off   = (0 until all.size by 3).map(offM(all, flown, timing, vehicle, _))
      assert(off.max < 1e-3, off.sorted.takeRight(5))

  for shared <- Seq(true, false) do
    test(
      s"a plant that uses one part of its command is predicted with SIMD like by its scalar, shared: $shared"
    ):
      val timing = LoopTiming.Predictive(predictor = train.predictor)
      val batch  = PairBatch(short, timing, train, threads = 1)
      assert(batch.engine(PaperPursuer(), PaperEvader(), shared, Seq(DelayTable.vpn)).isFast)
      val all   = worlds(shared)
      val flown = batch.fly(all)
      val off   = (0 until all.size by 9).map(offM(all, flown, timing, train, _))
      assert(off.max < 1e-3, off.sorted.takeRight(5))

  test("a plant of a first-order lag flies as the model with a lag"):
    val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0)
    val timing = LoopTiming.Stream()
    for key <- 1 to 5 do
      val plant =
        ScoredRollout(
          short.engagement,
          timing,
          DelayTable.vpn,
          PlantResponse(GuideExample.Lagging(0.9, 0.8))
        ).fly(key)
      val exact = ScoredRollout(short.engagement, timing, DelayTable.vpn, lag).fly(key)
      assertEqualsDouble(plant.meanDistanceM, exact.meanDistanceM, 1e-9)

  for (name, plant, addsStart) <- Seq(
      ("with drag", ReducedModel.AirSim, false),
      ("read away from where it is", Bicycle(1.2, 0.3, 4, 0.4), false),
      ("that looks at where it is", Sheltered, true)
    )
  do
    test(s"a plant $name flies from where it starts as its scalar does"):
      val stages = PlantLanes.of(plant).fold(fail(_), _.stages)
      assertEquals(stages.position.inputs.contains(PlantStages.StartX), addsStart)
      val duel = short.copy(pursuer = short.pursuer.copy(startX = 7, startY = -3))
      val all  = worlds(shared = true)
      for timing <- Seq(LoopTiming.Stream(), LoopTiming.Sequential()) do
        val flown = PairBatch(duel, timing, PlantResponse(plant), threads = 1).fly(all)
        for world <- 0 until all.size by 5 do
          val own = duel.copy(
            duel.pursuer.copy(policy = all.pursuer(world)),
            duel.evader.copy(policy = all.evader(world))
          )
          val scalar =
            ScoredRollout(own.engagement, timing, all.link(world), PlantResponse(plant)).fly(all.key(world))
          assertEqualsDouble(flown.meanDistanceM(world), scalar.meanDistanceM, 1e-3)

  private object Sheltered extends Plant[PlaneReading]:
    def initial: PlaneReading     = PlaneReading(0, 0, 0, 0)
    def stepS: Double             = 0.1
    def read(state: PlaneReading) = state
    def step(state: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
      val share = 0.8 + 0.01 * state.northM
      PlaneReading(
        state.northM + share * northMps * dtS,
        state.eastM + share * eastMps * dtS,
        share * northMps,
        share * eastMps
      )

  test("a plant that SIMD does not support is reported"):
    def engine(plant: Plant[?], shared: Boolean, timing: LoopTiming = LoopTiming.Stream()) =
      PairBatch(short, timing, PlantResponse(plant), 1)
        .engine(PaperPursuer(), PaperEvader(), shared, Seq(DelayTable.vpn)).text
    assert(engine(bicycle.plant, shared = true).startsWith("SIMD"))
    assert(engine(bicycle.plant, shared = false).startsWith("SIMD"))
    assert(engine(
      bicycle.plant,
      shared = true,
      LoopTiming.Predictive()
    ).startsWith("scalar: SIMD predicts by plants and by constant velocity"))
    val told = engine(Gusty, shared = true)
    assert(told.startsWith("scalar: the vehicle is no formula: ") && told.contains("nanoTime"), told)
    val slow = engine(Bicycle(1.2, 0.3, 4, 0.4, stepS = 1.5), shared = false)
    assert(slow.startsWith("scalar: ") && slow.contains("the vehicle's take 1.5"), slow)

  private object Gusty extends Plant[PlaneReading]:
    def initial: PlaneReading     = PlaneReading(0, 0, 0, 0)
    def stepS: Double             = 0.1
    def read(state: PlaneReading) = state
    def step(state: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
      state.copy(northM = state.northM + System.nanoTime % 3)
