package skein.bench

import skein.forward.*
import skein.gpu.{CudaGpu, Gpu}
import skein.lanes.*
import skein.lanes.gpu.{GpuAccelerator, GpuQuadrotors}
import skein.lanes.plant.LaneQuadrotors
import skein.policy.{NeuralPolicy, NeuralShape, PaperPursuer, Policy}
import skein.simd.WorldRandom
import skein.units.Vector3
import skein.vehicle.{Quadrotor, ReducedModel}

/** Forward simulation on a GPU and on this machine's processors, side by side, with comparable witnesses:
  * differing bits are counted. `bench/gpu` runs this and Crazyflow in turns on one GPU.
  *
  * Arguments: candidates in each row, and vehicles in the quadrotor's row.
  */
object GpuRates:
  private val Episodes = 32
  private val network  = NeuralShape(Vector(16, 16))
  private val weights  = Vector.tabulate(network.parameters)(i => math.sin(i * 1.7))

  def main(args: Array[String]): Unit =
    val Array(candidates, vehicles) = args.map(_.toInt)
    val gpu                         = CudaGpu.find().fold(sys.error, identity)
    val accelerator                 = Some(GpuAccelerator(gpu))
    println(s"${gpu.name}; ${Runtime.getRuntime.availableProcessors} processors")
    println("| work | GPU, M/s | its kernels alone, M/s | processors, M/s | times | witness | differ |")
    println("|---|---|---|---|---|---|---|")
    def paper(i: Int): Policy  = PaperPursuer(0.8 + 0.4 * (i % 1024) / 1024)
    def neural(i: Int): Policy = NeuralPolicy(network, weights.map(_ * (0.5 + (i % 1024) / 1024.0)))
    val drag                   = PlantResponse(ReducedModel.AirSim)
    def duels(
        name: String,
        timing: LoopTiming,
        model: VelocityResponse,
        share: Int,
        pursuer: Int => Policy
    ) =
      val count = candidates / share
      flown(name, timing, model, 2, Vector.tabulate(count)(i => Works.team(pursuer(i))))
    def teams(name: String, vehicles: Int, share: Int, candidate: Int => TeamCandidate) =
      val count = candidates / share
      flown(
        name,
        LoopTiming.Stream(),
        Works.model,
        vehicles,
        Vector.tabulate(count)(i => candidate(i % 1024))
      )
    def flown(
        name: String,
        timing: LoopTiming,
        model: VelocityResponse,
        vehicles: Int,
        teams: Vector[TeamCandidate]
    ) =
      val onGpu = TeamBatch(timing, model, accelerator = accelerator)
      val here  = TeamBatch(timing, model)
      row(name, gpu, vehicles, teams.size, teams.size / 64)(
        count => onGpu.fly(Teams(count, teams)).values(0),
        count => here.fly(Teams(count, teams)).values(0)
      )
    duels("stream over vpn", LoopTiming.Stream(), Works.model, 1, paper)
    duels("futures over vpn", LoopTiming.Futures(), Works.model, 1, paper)
    duels("stream, drag", LoopTiming.Stream(), drag, 1, paper)
    duels("stream, network of 16 and 16", LoopTiming.Stream(), Works.model, 4, neural)
    duels("stream, quadrotors", LoopTiming.Stream(), VelocityResponses.quadrotor(), 32, paper)
    teams("stream, surround of 6", 6, 8, TeamRates.surround(6))
    teams("stream, surround of 20", 20, 32, TeamRates.surround(20))
    teams("stream, formation of 6", 6, 8, TeamRates.formation(6))
    teams("stream, crossing of 6", 6, 32, TeamRates.crossing(6))
    quadrotor(gpu, vehicles)

  /** @param onCpu number of candidates that are also simulated on the processors, and compared
    * @param there simulates this number of candidates on the GPU, `here` on the processors; results by
    *   candidate and then by episode
    */
  private def row(name: String, gpu: Gpu, vehicles: Int, candidates: Int, onCpu: Int)(
      there: Int => Array[Float],
      here: Int => Array[Float]
  ): Unit =
    // A warm-up: makes timetables and code.
    for _ <- 1 to 3 do
      there(candidates): Unit
      here(onCpu): Unit
    val ran             = gpu.ranNs
    val (a, t)          = timed(there(candidates))
    val kernel          = (gpu.ranNs - ran) * 1e-9
    val (b, s)          = timed(here(onCpu))
    def bits(of: Float) = java.lang.Float.floatToRawIntBits(of)
    val differ          = (0 until onCpu * Episodes).count(i => bits(a(i)) != bits(b(i)))
    val mean            = b.map(_.toDouble).sum / b.length
    val steps           = Episodes * vehicles * 600.0
    tell(
      name,
      candidates * steps / t,
      candidates * steps / kernel,
      onCpu * steps / s,
      f"$mean%.4f m",
      s"$differ of ${onCpu * Episodes}"
    )

  private final class Teams(candidates: Int, teams: Vector[TeamCandidate]) extends TeamWorlds:
    def size: Int                            = candidates * Episodes
    override def shareEpisodes: Boolean      = true
    override def episodesOfEach: Int         = Episodes
    def key(world: Int): Int                 = WorldRandom.key(3, 0, world % Episodes)
    def link(world: Int): DelayTable         = DelayTable.vpn
    def candidate(world: Int): TeamCandidate = teams(world / Episodes)

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
