package skein.bench

import java.nio.file.{Files, Path}
import java.nio.{ByteBuffer, ByteOrder}
import skein.environment.{Autoreset, EnvironmentBatch, EnvironmentBuffers, EnvironmentSettings}
import skein.forward.{DelayTable, Delays, Duel, LoopTiming, PlantResponse}
import skein.lanes.{DuelBatch, DuelWorlds}
import skein.policy.{PaperEvader, PaperPursuer, HeadingPolicy}
import skein.scenario.Scenarios
import skein.vehicle.ReducedModel

/** How fast are environments whose observations are not read, beside the engine's own flights: the reference
  * for `bench/python/environments.py`. The duel over `vpn`, under `stream`.
  */
@main def EnvironmentRates(): Unit =
  for count <- Seq(64, 1024, 4096) do
    val (steps, distance) = environments(count)
    println(f"environments n=$count: ${steps / 1e6}%.1f M steps/s, first ends at $distance%.3f m")
  val (steps, distance) = flights(4096)
  println(f"flights of a search n=4096: ${steps / 1e6}%.1f M steps/s, first comes to $distance%.3f m")

/** Cost of `steps` environment steps in 4,096 environments whose actions are always 0, under same-step
  * autoreset: time by the clock and by the processors, and the process's peak memory. Run: `./sbtw
  * 'bench/runMain skein.bench.EnvironmentSteps 200000000'`; the counterpart in Python is
  * `bench/python/environments.py`.
  */
@main def EnvironmentSteps(steps: Long): Unit =
  val count = 4096
  val block = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, count)).order(ByteOrder.nativeOrder)
  val batch = EnvironmentBatch
    .of(EnvironmentSettings(), count, Autoreset.SameStep, block)(using Scenarios.ours)
    .fold(sys.error(_), identity)
  batch.reset(Array.tabulate(count)(_.toLong))
  val from             = System.nanoTime()
  var (ends, distance) = (0L, 0.0)
  for _ <- 0L until steps / count do
    batch.step()
    if block.get(4 * (2 + 2 * 9 + 2) * count + count) != 0 then
      ends += 1
      distance += block.getFloat(4 * (2 + 2 * 9) * count)
  val seconds   = (System.nanoTime() - from) * 1e-9
  val processor = ProcessHandle.current.info.totalCpuDuration.get.toMillis * 1e-3
  val most      =
    Files.readString(Path.of("/proc/self/status")).linesIterator.find(_.startsWith("VmHWM")).getOrElse("")
  println(
    f"${steps / count * count}%,d steps in $seconds%.1f s, $processor%.1f s of processor time " +
      f"with start and compilation; most memory ${most.split("\\s+")(1).toLong / 1024} MB; the " +
      f"first environment ended $ends times, at ${distance / ends.max(1)}%.3f m"
  )

private val periods = 600

private def environments(count: Int): (Double, Float) =
  val block = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, count)).order(ByteOrder.nativeOrder)
  val batch =
    EnvironmentBatch
      .of(EnvironmentSettings(), count, Autoreset.NextStep, block)(using Scenarios.ours)
      .fold(sys.error(_), identity)
  batch.reset(Array.tabulate(count)(_.toLong))
  val rate = bestRate(() => (0 until 200).foreach(_ => batch.step()))
  (rate * 200 * count, block.getFloat(4 * (2 + 2 * 9) * count))

private def flights(count: Int): (Double, Float) =
  val batch  = DuelBatch(Duel.paper, LoopTiming.Stream(), PlantResponse(ReducedModel.AirSimLag))
  val worlds = new DuelWorlds:
    def size                               = count
    override def shareEpisodes             = true
    def key(world: Int): Int               = world / 128
    def link(world: Int): Delays           = DelayTable.vpn
    def pursuer(world: Int): HeadingPolicy = pursuing
    def evader(world: Int): HeadingPolicy  = evading
    private val (pursuing, evading)        = (PaperPursuer(), PaperEvader())
  var last = 0f
  val rate = bestRate(() => last = batch.fly(worlds).meanLast10sM(0))
  (rate * periods * count, last)

/** Calls a second: the best of ten intervals of 0.3 s, after 3 s of warm-up. */
private def bestRate(call: () => Unit): Double =
  def stretch(seconds: Double): Double =
    val from  = System.nanoTime()
    var calls = 0
    while System.nanoTime() - from < seconds * 1e9 do
      call()
      calls += 1
    calls / ((System.nanoTime() - from) * 1e-9)
  stretch(3): Unit
  Seq.fill(10)(stretch(0.3)).max
