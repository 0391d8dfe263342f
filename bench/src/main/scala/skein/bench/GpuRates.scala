package skein.bench

import skein.forward.*
import skein.gpu.Gpu
import skein.lanes.{DuelBatch, DuelNumber, DuelWorlds, GpuQuadrotors, LaneQuadrotors}
import skein.policy.{NeuralPolicy, NeuralShape, PaperEvader, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.units.Vector3
import skein.vehicle.{Quadrotor, ReducedModel}

/** Forward simulation on a GPU and on this machine's processors, side by side, with the same witnesses: what
  * differs is counted, to the bit. `bench/gpu` runs this beside Crazyflow on the same GPU.
  *
  * Arguments: candidates of each row, and vehicles of the quadrotor's.
  */
object GpuRates:
  private val Episodes = 8
  private val asked    = Set(DuelNumber.MeanLast10s)
  private val network  = NeuralShape(Vector(16, 16))
  private val weights  = Vector.tabulate(network.parameters)(i => math.sin(i * 1.7))

  def main(args: Array[String]): Unit =
    val Array(candidates, vehicles) = args.map(_.toInt)
    val gpu                         = Gpu.find().fold(sys.error, identity)
    println(s"${gpu.name}; ${Runtime.getRuntime.availableProcessors} processors")
    println("| work | GPU, M/s | its kernels alone, M/s | processors, M/s | times | witness | differ |")
    println("|---|---|---|---|---|---|---|")
    def paper(i: Int): Policy  = PaperPursuer(0.8 + 0.4 * (i % 1024) / 1024)
    def neural(i: Int): Policy = NeuralPolicy(network, weights.map(_ * (0.5 + (i % 1024) / 1024.0)))
    val drag                   = ReducedResponse(ReducedModel.AirSim)
    row("stream over vpn", gpu, LoopTiming.Stream(), Works.model, candidates, candidates / 16, paper)
    row("futures over vpn", gpu, LoopTiming.Futures(), Works.model, candidates, candidates / 16, paper)
    row("stream, drag", gpu, LoopTiming.Stream(), drag, candidates, candidates / 64, paper)
    row(
      "stream, network of 16 and 16",
      gpu,
      LoopTiming.Stream(),
      Works.model,
      candidates / 4,
      candidates / 256,
      neural
    )
    val quadrotors = VelocityResponses.quadrotor()
    row("stream, quadrotors", gpu, LoopTiming.Stream(), quadrotors, candidates / 16, candidates / 4096, paper)
    quadrotor(gpu, vehicles)

  /** @param onCpu so many candidates fly on the processors, too, and are compared
    */
  private def row(
      name: String,
      gpu: Gpu,
      timing: LoopTiming,
      model: VelocityResponse,
      candidates: Int,
      onCpu: Int,
      pursuer: Int => Policy
  ): Unit =
    val policies = Vector.tabulate(candidates)(pursuer)
    val onGpu    = DuelBatch(Duel.paper, timing, model, gpu = Some(gpu))
    val here     = DuelBatch(Duel.paper, timing, model)
    // Once for nothing: timetables and code are made.
    onGpu.fly(Worlds(candidates, policies)): Unit
    here.fly(Worlds(onCpu.max(16), policies)): Unit
    val ran    = gpu.ranNs
    val (a, t) = timed(onGpu.fly(Worlds(candidates, policies)))
    val kernel = (gpu.ranNs - ran) * 1e-9
    val (b, s) = timed(here.fly(Worlds(onCpu, policies)))
    // A world is a candidate's episode; the first candidates are the same.
    val differ = (0 until onCpu * Episodes).count(i => a.meanLast10sM(i) != b.meanLast10sM(i))
    val mean   = b.meanLast10sM.map(_.toDouble).sum / b.meanLast10sM.length
    val steps  = Episodes * 1200.0
    tell(
      name,
      candidates * steps / t,
      candidates * steps / kernel,
      onCpu * steps / s,
      f"$mean%.4f m",
      s"$differ of ${onCpu * Episodes}"
    )

  private final class Worlds(candidates: Int, policies: Vector[Policy]) extends DuelWorlds:
    private val evader                  = PaperEvader()
    def size: Int                       = candidates * Episodes
    override def shareEpisodes: Boolean = true
    override def episodesOfEach: Int    = Episodes
    override def asked: Set[DuelNumber] = GpuRates.asked
    def key(world: Int): Int            = WorldRandom.key(3, 0, world % Episodes)
    def link(world: Int): DelayTable    = DelayTable.vpn
    def pursuer(world: Int): Policy     = policies(world / Episodes)
    def evader(world: Int): Policy      = this.evader

  private def quadrotor(gpu: Gpu, vehicles: Int): Unit =
    val steps    = 10_000
    val onGpu    = GpuQuadrotors.of(gpu, Quadrotor.AirSim).fold(sys.error, identity)
    val here     = LaneQuadrotors.of(Quadrotor.AirSim).fold(sys.error, identity)
    val goals    = Array.fill(vehicles)(Vector3(0, 0, -20))
    val commands = Array.tabulate(vehicles)(i => Vector3(10 * math.cos(i), 10 * math.sin(i), -20))
    onGpu.fly(goals, commands, 10): Unit
    val ran    = gpu.ranNs
    val (a, t) = timed(onGpu.fly(goals, commands, steps))
    val kernel = (gpu.ranNs - ran) * 1e-9
    for i <- 0 until LaneQuadrotors.VEHICLES do
      here.hover(i, goals(i))
      here.command(i, commands(i).x.toFloat, commands(i).y.toFloat, commands(i).z.toFloat)
    val (_, s) = timed(here.fly(steps))
    val differ = (0 until LaneQuadrotors.VEHICLES).count(i => a(i) != here.positionNed(i))
    tell(
      "quadrotors with their controllers, steps of 3 ms; here one thread",
      vehicles.toDouble * steps / t,
      vehicles.toDouble * steps / kernel,
      LaneQuadrotors.VEHICLES.toDouble * steps / s,
      f"${here.positionNed(1).x}%.4f m",
      s"$differ of ${LaneQuadrotors.VEHICLES}"
    )

  private def tell(
      name: String,
      gpu: Double,
      kernel: Double,
      cpu: Double,
      witness: String,
      differ: String
  ): Unit =
    println(
      f"| $name | ${gpu * 1e-6}%.0f | ${kernel * 1e-6}%.0f | ${cpu * 1e-6}%.1f | ${gpu / cpu}%.0f | $witness | $differ |"
    )

  private def timed[A](body: => A): (A, Double) =
    val start  = System.nanoTime()
    val result = body
    (result, (System.nanoTime() - start) * 1e-9)
