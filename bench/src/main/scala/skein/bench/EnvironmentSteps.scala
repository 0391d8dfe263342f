package skein.bench

import java.nio.file.{Files, Path}
import java.nio.{ByteBuffer, ByteOrder}
import skein.environment.{Autoreset, EnvironmentBatch, EnvironmentBuffers, EnvironmentSettings}
import skein.scenario.Scenarios

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
