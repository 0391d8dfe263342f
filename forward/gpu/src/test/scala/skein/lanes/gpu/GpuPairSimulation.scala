package skein.lanes.gpu

import skein.forward.*
import skein.gpu.{Gpu, TestGpus}
import skein.lanes.*
import skein.policy.{PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.vehicle.ReducedModel

/** Results on a GPU are bit-identical to those on the CPU: by an interpreter of the GPU's instructions, and
  * by the GPU itself, where there is one.
  */
class GpuPairSimulation extends munit.FunSuite, TestGpus:
  override def munitTimeout: scala.concurrent.duration.Duration =
    scala.concurrent.duration.Duration(5, "min")

  private val lag = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  private val plants = Vector[(String, VelocityResponse)](
    "lag"        -> lag,
    "drag"       -> PlantResponse(ReducedModel.AirSim),
    "a Plant"    -> PlantResponse(Bicycle(1.2, 0.3, 4, 0.4)),
    "quadrotors" -> VelocityResponses.quadrotor()
  )

  private val loops = TestLoops.unpredicted

  private val weights = Array.tabulate(RectifiedNetwork.Weights)(i => math.sin(i * 1.7))

  private val pursuers: Vector[(String, Int => Policy)] = Vector(
    "the paper's"                -> (world => PaperPursuer(0.6 + 0.1 * world)),
    "one that remembers"         -> (world => TrendPursuer(3, 0.5, 0.5 + 0.2 * world)),
    "one that asks for ages"     -> (world => AgeAwarePursuer(8, 0.3 * world, 1)),
    "a network"                  -> (world => RectifiedNetwork(weights.map(_ * (0.5 + 0.2 * world)), 1.2)),
    "now the one, now the other" -> (world =>
      if world % 2 == 0 then PaperPursuer() else TrendPursuer(3, 0.5, 1)
    ),
    "now and then one that is no formula" -> (world =>
      if world == 1 then PairBatchSimulation.Straight else PaperPursuer()
    )
  )

  private final class Worlds(val size: Int, episodes: Int, link: Delays, of: Int => Policy)
      extends PairWorlds:
    override def shareEpisodes: Boolean = true
    override def episodesOfEach: Int    = episodes
    private val pursuers                = Vector.tabulate(size)(world => of(world / episodes))
    private val evaders                 = Vector(PaperEvader(7), PaperEvader(8))
    def key(world: Int): Int            = WorldRandom.key(5, 0, world % episodes)
    def link(world: Int): Delays        = link
    def pursuer(world: Int): Policy     = pursuers(world)
    def evader(world: Int): Policy      = evaders(world / episodes % 2)

  private def check(
      gpu: Gpu,
      model: VelocityResponse,
      timing: LoopTiming,
      link: Delays,
      durationS: Double,
      pursuer: Int => Policy,
      size: Int = 6
  ): Unit =
    val duel   = Pair.paper.copy(evader = Pair.paper.evader.copy(startY = 2), durationS = durationS)
    val worlds = Worlds(size, episodes = 2, link, pursuer)
    val onCpu  = PairBatch(duel, timing, model, threads = 1)
    val onGpu  = PairBatch(duel, timing, model, threads = 1, Some(GpuAccelerator(gpu)))
    assertEquals(
      onGpu.engine(pursuer(0), PaperEvader(), shareEpisodes = true, Seq(link)).text,
      s"GPU, ${gpu.name}: a thread a candidate"
    )
    val (told, wanted) = (onGpu.fly(worlds, 4), onCpu.fly(worlds, 4))
    assertEquals(told.flown, size)
    for number <- PairNumber.values; world <- 0 until size do
      assertEquals(
        java.lang.Float.floatToRawIntBits(told(number)(world)),
        java.lang.Float.floatToRawIntBits(wanted(number)(world)),
        s"$number of world $world: ${told(number)(world)} and ${wanted(number)(world)}"
      )

  private val predictors = Seq(
    "its own lag"       -> LoopTiming.Predictive(predictor = lag.predictor),
    "drag"              -> LoopTiming.Predictive(predictor = PlantResponse(ReducedModel.AirSim).predictor),
    "constant velocity" -> LoopTiming.Predictive(predictor = skein.vehicle.ConstantVelocity)
  )

  for (name, gpu) <- gpus do
    for (predictor, timing) <- predictors; (plant, model) <- plants do
      test(s"$name, $plant, predicted by $predictor"):
        check(gpu(), model, timing, DelayTable.vpn, if plant == "quadrotors" then 1 else 12, pursuers(2)._2)

    for (plant, model) <- plants; timing <- loops do
      test(s"$name, $plant, $timing"):
        check(gpu(), model, timing, DelayTable.vpn, if plant == "quadrotors" then 1 else 12, pursuers(0)._2)

    for (pursuer, of) <- pursuers; timing <- Seq(LoopTiming.Stream(), LoopTiming.Futures()) do
      test(s"$name, $pursuer, $timing"):
        check(gpu(), lag, timing, LinkDelays.vpnMixed, 12, of)
