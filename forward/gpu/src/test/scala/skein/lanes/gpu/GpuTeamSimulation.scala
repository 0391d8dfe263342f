package skein.lanes.gpu

import skein.forward.*
import skein.gpu.{Gpu, TestGpus}
import skein.lanes.*
import skein.lanes.score.{Judged, OfMoment}
import skein.policy.Policy
import skein.scenario.*
import skein.simd.WorldRandom
import skein.vehicle.ReducedModel

/** Results of teams are bit-identical to those of the CPU, as [[GpuPairSimulation]] tests for duels. */
class GpuTeamSimulation extends munit.FunSuite, TestGpus:
  private val lag  = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val drag = PlantResponse(ReducedModel.AirSim)

  private val loops = TestLoops.unpredicted :+ LoopTiming.Predictive(predictor = lag.predictor)

  private val reductions: Vector[Reduction | OfMoment] =
    Reduction.values.toVector ++ Vector(OfMoment.Newest, OfMoment.FirstWithin(4))

  private val scenarios: Seq[(String, Int => Scenario)] = Seq(
    "surround"  -> (i => Surround(6, ringM = 5 + i, pursuerMps = 6 + i)),
    "formation" -> (i => Formation(spacingM = 3 + 0.5 * i, leaderMps = 3 + 0.5 * i)),
    "crossing"  -> (i => Crossing(4, entryM = 15, laneM = 1 + 0.5 * i, marginM = 0.5 + 0.2 * i))
  )

  private final class Worlds(candidates: Vector[TeamCandidate], episodes: Int, link: Delays)
      extends TeamWorlds:
    def size: Int                            = candidates.size * episodes
    override def shareEpisodes: Boolean      = true
    override def episodesOfEach: Int         = episodes
    def key(world: Int): Int                 = WorldRandom.key(5, 0, world % episodes)
    def link(world: Int): Delays             = link
    def candidate(world: Int): TeamCandidate = candidates(world / episodes)

  private def check(
      gpu: Gpu,
      of: Int => Scenario,
      model: VelocityResponse,
      timing: LoopTiming,
      own: Int => Option[Policy] = _ => None
  ): Unit =
    val durationS  = 3.0
    val candidates = Vector.tabulate(3): i =>
      val scenario = of(i)
      val judged   =
        for reduction <- reductions
        yield Judged(OffRing(4 + i), reduction, if reduction == Reduction.Mean then 2 else 0, everyS = 0.1)
      val plain = Engagement.of(scenario.fleet, durationS)
      val team  =
        plain.copy(agents = plain.agents.map(each => each.copy(policy = own(i).getOrElse(each.policy))))
      TeamCandidate(team, judged)
    val worlds = Worlds(candidates, episodes = 2, DelayTable.vpn)
    val onCpu  = TeamBatch(timing, model, threads = 1)
    val onGpu  = TeamBatch(timing, model, threads = 1, Some(GpuAccelerator(gpu)))
    assertEquals(
      onGpu.engine(candidates(0), shareEpisodes = true, Seq(DelayTable.vpn)).text,
      s"GPU, ${gpu.name}: a thread a candidate"
    )
    val (told, wanted) = (onGpu.fly(worlds), onCpu.fly(worlds))
    assertEquals(told.flown, worlds.size)
    for (reduction, number) <- reductions.zipWithIndex; world <- 0 until worlds.size do
      val (ours, theirs) = (told.values(number)(world), wanted.values(number)(world))
      assertEquals(
        java.lang.Float.floatToRawIntBits(ours),
        java.lang.Float.floatToRawIntBits(theirs),
        s"$reduction of world $world: $ours and $theirs"
      )

  for (name, gpu) <- gpus; (scenario, of) <- scenarios do
    for timing <- loops do
      test(s"$name, $scenario, $timing: outcomes equal the CPU's, to the bit"):
        check(gpu(), of, lag, timing)
    test(s"$name, $scenario with drag: outcomes equal the CPU's, to the bit"):
      check(gpu(), of, drag, LoopTiming.Stream())

  for (name, gpu) <- gpus do
    test(s"$name: candidates that are not formulas are simulated by the CPU"):
      check(gpu(), scenarios(0)._2, lag, LoopTiming.Stream(), i => Option.when(i == 1)(Zigzag))
