package skein.bench.jmh

import java.util.concurrent.TimeUnit
import org.openjdk.jmh.annotations.*
import skein.rollout.QuadrotorKernel
import skein.units.Vector3

/** How long does the quadrotor with its controller take for 1,000 steps of 3 ms, `QuadrotorKernel.VEHICLES` of them side
  * by side, warm, on one thread? Run: `./sbtw "benchJmh/Jmh/run QuadrotorBenchmark"`.
  */
@State(Scope.Benchmark)
@BenchmarkMode(Array(Mode.AverageTime))
@OutputTimeUnit(TimeUnit.MILLISECONDS)
@Warmup(iterations = 4, time = 4)
@Measurement(iterations = 5, time = 2)
@Fork(value = 1, jvmArgsAppend = Array("--add-modules", "jdk.incubator.vector"))
class QuadrotorBenchmark:
  private var kernel: QuadrotorKernel = null
  private var witness                 = 0.0

  @Setup
  def prepare(): Unit = kernel = QuadrotorKernel()

  @TearDown
  def show(): Unit = println(f"witness, speed after 3 s: $witness%.4f m/s")

  @Benchmark
  def steps(): Double =
    for i <- 0 until QuadrotorKernel.VEHICLES do
      kernel.hover(i, Vector3(0, 0, -20))
      kernel.command(i, 10, 0, -20)
    kernel.fly(1000)
    witness = kernel.velocityNed(0).x
    witness
