package skein.lanes

import java.nio.file.{Files, Path}
import skein.forward.*
import skein.identify.Tilting
import skein.lanes.score.Judged
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.scenario.{OffRing, Reduction, Surround}
import skein.simd.WorldRandom
import skein.vehicle.{ReducedModel, SensorNoise, TiltModel}

/** The table of docs/engines.md agrees with the engines, cell by cell; and worlds listed for SIMD or for
  * stepped vehicles have the scalar reference's results. Bodies of MuJoCo's have no column: they need a
  * library that is not everywhere; `skein.mujoco.FlownByVehiclesLiveSuite` covers them.
  */
class FlownByLanesSuite extends munit.FunSuite:
  private val root =
    Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at => Files.exists(at.resolve("sbtw"))).get

  private val plants = Vector[(String, VelocityResponse)](
    "no lag"            -> VelocityResponses.Ideal,
    "lag"               -> VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05),
    "drag"              -> PlantResponse(ReducedModel.AirSim),
    "your own `Plant`"  -> PlantResponse(Bicycle(1.2, 0.3, 4, 0.4)),
    "the quadrotor"     -> VelocityResponses.quadrotor(),
    "in space (`tilt`)" -> SpatialResponse(TiltModel.AirSim)
  )

  private def loops(model: VelocityResponse): Vector[LoopTiming] = Vector(
    LoopTiming.Paused(),
    LoopTiming.Sequential(),
    LoopTiming.Futures(),
    LoopTiming.Stream(),
    LoopTiming.Predictive(predictor = model.predictor)
  )

  private val noise =
    SensorNoise.parse("position=0.2,velocity=0.1,drift=1/20s,dropout=5%,outage=0.3s/2s")
      .fold(fail(_), identity)

  private val duel = Pair.paper.copy(
    evader = Pair.paper.evader.copy(startY = 2), // straight ahead a rounding error would decide where to turn
    durationS = 3
  )

  private val policies: Vector[(String, Policy)] = Vector(
    "a formula"                    -> PaperPursuer(),
    "a formula that remembers"     -> TrendPursuer(3, 0.5, 1),
    "a formula that asks for ages" -> AgeAwarePursuer(8, 1, 1),
    "no formula"                   -> PairBatchSimulation.Straight
  )

  /** The table's entries for worlds under a loop, by plant. */
  private val table: Map[(String, String), Map[String, String]] =
    val rows = Files
      .readString(root.resolve("docs/engines.md"))
      .linesIterator
      .dropWhile(!_.startsWith("| worlds | loop |"))
      .takeWhile(_.startsWith("|"))
      .map(_.stripPrefix("|").stripSuffix("|").split('|').map(_.trim).toVector)
      .toVector
    val header = rows.head.drop(2)
    assertEquals(header, plants.map(_._1), "the table's columns")
    (for
      row  <- rows.drop(2)
      loop <- row(1).split(", ")
    yield (row(0), loop.stripPrefix("`").stripSuffix("`")) -> header.zip(row.drop(2)).toMap).toMap

  /** The engine's sentence in the table's words. */
  private def word(engine: String): String =
    if engine.startsWith("scalar: ") then "scalar"
    else if engine.endsWith("loops by the scalar engine") then "vehicles"
    else
      assert(engine.startsWith("SIMD, "), engine)
      "SIMD"

  private def nameOf(timing: LoopTiming) = timing.productPrefix.toLowerCase

  for
    (plant, model)   <- plants
    timing           <- loops(model)
    (worlds, shared) <- Seq("shared delays" -> true, "own delays" -> false)
  do
    test(
      s"duels, $worlds, ${nameOf(timing)}, $plant: the engine is the one in docs/engines.md, and agrees with the scalar reference"
    ):
      val batch = PairBatch(duel, timing, model, threads = 1)
      val said  = table((worlds, nameOf(timing)))(plant)
      for (kind, policy) <- policies do
        val engine = batch.engine(policy, PaperEvader(), shared, Seq(DelayTable.vpn)).text
        // Quadrotors are stepped together whether or not policies are formulas.
        val expected =
          if kind != "no formula" then said else if plant == "the quadrotor" then "vehicles" else "scalar"
        assertEquals(word(engine), expected, s"$kind: $engine")
      if said != "scalar" then agree(batch, timing, model, shared)

  for
    (plant, model)   <- plants
    timing           <- loops(model)
    (worlds, shared) <- Seq("shared delays" -> true, "own delays" -> false)
  do
    test(
      s"duels, $worlds, ${nameOf(timing)}, $plant, with a sensor: the engine agrees with the text below the table"
    ):
      val seeing = duel.copy(pursuer = duel.pursuer.copy(eye = Some(GuideCamera.model)))
      val engine = PairBatch(seeing, timing, model, threads = 1)
        .engine(PaperPursuer(), PaperEvader(), shared, Seq(DelayTable.vpn)).text
      val said    = table((worlds, nameOf(timing)))(plant)
      val isTimed = shared || !timing.isInstanceOf[LoopTiming.Paused]
      assertEquals(word(engine), if said == "SIMD" && isTimed then "SIMD" else "scalar", engine)

  for
    (plant, model)   <- plants
    timing           <- loops(model)
    (worlds, shared) <- Seq("shared delays" -> true, "own delays" -> false)
  do
    test(
      s"duels, $worlds, ${nameOf(timing)}, $plant, by readings with errors: the engine of the table, as the reference"
    ):
      val sensed = SensedResponse(model, noise)
      val batch  = PairBatch(duel, timing, sensed, threads = 1)
      val engine = batch.engine(PaperPursuer(), PaperEvader(), shared, Seq(DelayTable.vpn)).text
      assertEquals(word(engine), table((worlds, nameOf(timing)))(plant), engine)
      agree(batch, timing, sensed, shared)

  for
    plant  <- Seq(Skating(0.4, 1.5), Tilting(0.95, 0.9, 0.2))
    shared <- Seq(true, false)
  do
    test(s"predictive by $plant itself, ${if shared then "shared" else "own"} delays: it flies by lanes"):
      val model  = PlantResponse(plant)
      val batch  = PairBatch(duel, LoopTiming.Predictive(predictor = model.predictor), model, threads = 1)
      val engine = batch.engine(PaperPursuer(), PaperEvader(), shared, Seq(DelayTable.vpn)).text
      assertEquals(word(engine), "SIMD", engine)

  private def agree(batch: PairBatch, timing: LoopTiming, model: VelocityResponse, shared: Boolean): Unit =
    val all = new PairWorlds:
      def size: Int                       = 24
      override def shareEpisodes: Boolean = shared
      def key(world: Int): Int            = WorldRandom.key(5, 0, if shared then 1 else world)
      def link(world: Int): Delays        = DelayTable.vpn
      def pursuer(world: Int): Policy     = PaperPursuer(0.6 + 0.004 * world)
      def evader(world: Int): Policy      = PaperEvader(7 + 0.01 * world)
    val flown = batch.fly(all)
    for world <- 0 until all.size by 5 do
      val own =
        Pair(duel.pursuer.copy(policy = all.pursuer(world)), duel.evader.copy(policy = all.evader(world)), 3)
      val scalar = ScoredRollout(own.engagement, timing, DelayTable.vpn, model).fly(all.key(world))
      assertEqualsDouble(flown.meanDistanceM(world), scalar.meanDistanceM, 4e-3, s"world $world")
      assertEqualsDouble(flown.pursuerEffortRad(world), scalar.pursuerEffortRad, 4e-3, s"world $world")

  for
    (plant, model) <- plants
    timing         <- loops(model)
  do
    test(s"teams, ${nameOf(timing)}, $plant: the engine says what the table does"):
      val surround = Surround(6)
      val team     =
        TeamCandidate(
          Engagement.of(surround.fleet, 3),
          Vector(Judged(OffRing(surround.ringM), Reduction.Rms, 0))
        )
      val batch = TeamBatch(timing, model, threads = 1)
      for (worlds, shared) <- Seq("shared delays" -> true, "own delays" -> false) do
        val engine = batch.engine(team, shared, Seq(DelayTable.vpn)).text
        assertEquals(word(engine), table((worlds, nameOf(timing)))(plant), engine)

  test(
    "a plant with steps too long for SIMD is refused in teams under every loop with delays"
  ):
    val model = PlantResponse(Bicycle(1.2, 0.3, 4, 0.4, stepS = 1.5))
    val team  = TeamCandidate(
      Engagement.of(Surround(6).fleet, 3),
      Vector(Judged(OffRing(8), Reduction.Rms, 0))
    )
    for timing <- loops(model).tail do
      val engine = TeamBatch(timing, model, threads = 1).engine(team, false, Seq(DelayTable.vpn)).text
      assert(engine.startsWith("scalar: SIMD supports steps of"), s"$timing: $engine")

  test("the table has rows for exactly what the engines support"):
    val all =
      for
        worlds <- Seq("shared delays", "own delays")
        timing <- loops(VelocityResponses.Ideal)
      yield (worlds, nameOf(timing))
    assertEquals(table.keySet, all.toSet)
