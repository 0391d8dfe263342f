package skein.bench.jmh

import java.util.concurrent.TimeUnit
import org.openjdk.jmh.annotations.*
import skein.bench.Works
import skein.rollout.*

/** How long does one call of a batch take, warm, on one thread? `stream` over `vpn`, 60 s, the reduced model: divide
  * `worlds` times 1,200 agent-steps by it. Run: `./sbtw "benchJmh/Jmh/run KernelBenchmark"`.
  */
@State(Scope.Benchmark)
@BenchmarkMode(Array(Mode.AverageTime))
@OutputTimeUnit(TimeUnit.MILLISECONDS)
@Warmup(iterations = 4, time = 4)
@Measurement(iterations = 5, time = 2)
@Fork(value = 1, jvmArgsAppend = Array("--add-modules", "jdk.incubator.vector"))
class KernelBenchmark:
  @Param(Array("128", "1024"))
  var worlds: Int = 0

  private var batch: DuelBatch = null
  private var witness          = 0.0

  @Setup
  def prepare(): Unit = batch = Works.batch(LoopTiming.Stream(), 1)

  @TearDown
  def show(): Unit = println(f"witness, mean of the last 10 s: $witness%.4f m")

  /** All candidates on one episode; its timetable is known after the first call. */
  @Benchmark
  def candidates(): Double = fly(Works.Candidates(worlds, worlds, DelayTable.vpn, 1))

  /** Every world with delays of its own. */
  @Benchmark
  def singleWorlds(): Double = fly(Works.Candidates(worlds, 1, DelayTable.vpn, 1))

  private def fly(candidates: Works.Candidates): Double =
    witness = batch.fly(candidates).meanLast10sM.map(_.toDouble).sum / worlds
    witness
