package skein.blocks

import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}

/** The cost of coordinating many workers, by simulation: `./sbtw "blocks/Test/runMain skein.blocks.scale
  * 10000 1000000 DIR"`. Speeds are heavy-tailed (Pareto, 1.5), a block takes a minute on average at a speed
  * of 1; 5 % of the workers die in an hour, each is cut off for half a minute once in four hours, and every
  * half an hour a fifth of them simultaneously for two minutes. Fails where the answer is wrong, or where a
  * block counts twice.
  *
  * @param out folder for the ledger, which is deleted at the end
  */
@main def scale(workers: Int, blocks: Int, out: String): Unit =
  val begun  = System.nanoTime()
  val folder = Files.createDirectories(Path.of(out))
  Files.deleteIfExists(folder.resolve(Ledger.Name)): Unit
  val flown   = CoordinatorSimulation(1, workers, blocks, folder, meanSeconds = 60)
  val cpuFrom = Used.cpuNanos
  var most    = 0L
  var next    = 0
  flown.fly(
    deathsAnHour = 0.05,
    cutsAnHour = 0.25,
    splits = (1 to 100).map(_ * 1800.0),
    saving = true
  ):
    if flown.done >= next then
      next += blocks / 8
      most = most.max(Used.heapBytes)
      Console.err.println(
        f"${flown.seconds}%.0f s: ${flown.done}%,d blocks, heap " +
          f"${Used.heapBytes / 1e6}%.0f MB, ${(System.nanoTime() - begun) * 1e-9}%.0f s of ours"
      )
  val processNanos = Used.cpuNanos - cpuFrom
  val lived        = flown.seconds * workers
  require(flown.result == CoordinatorSimulation.alone(blocks), "another answer than that of one process")
  flown.close()
  val ledger = Files.size(flown.file)
  val opened = System.nanoTime()
  val audit  = Ledger.audit(flown.file)
  require(audit == Ledger.Audit(blocks, 0, 0) && flown.acceptedTwice == 0, audit.toString)
  Files.delete(flown.file)
  println(
    f"$workers%,d workers, $blocks%,d blocks in ${flown.seconds / 3600}%.2f simulated " +
      f"hours; ${flown.deaths}%,d deaths, ${flown.cuts}%,d times somebody was cut off"
  )
  println(
    f"the answer of one process to the bit; ${audit.blocks}%,d blocks, each once, " +
      f"read in ${(System.nanoTime() - opened) * 1e-9}%.1f s; ${flown.counts}"
  )
  println(
    f"messages: ${flown.messages}%,d, ${flown.messages / flown.seconds}%,.0f " +
      f"and ${flown.messageBytes / flown.seconds / 1e3}%,.0f kB a second"
  )
  println(
    f"the coordinator decides for ${flown.decidingNanos * 1e-9}%.1f s, " +
      f"${1e-7 * flown.decidingNanos / flown.seconds}%.2f %% of a core, and waits " +
      f"${flown.savingNanos * 1e-9}%.1f s for the disk; all of this process took " +
      f"${processNanos * 1e-9}%.0f s, ${1e-7 * processNanos / flown.seconds}%.1f %% of a core"
  )
  println(
    f"heap of all of it, the simulated workers included: ${most / 1e6}%.0f MB; ledger: ${ledger / 1e6}%.1f MB"
  )
  println(
    f"of all workers' time: ${1e-7 * flown.usefulNanos / lived}%.1f %% on what counts, " +
      f"${1e-7 * (flown.computedNanos - flown.usefulNanos) / lived}%.1f %% on what was lost or came twice"
  )

private object Used:
  /** Used memory after a garbage collection, bytes. */
  def heapBytes: Long =
    System.gc()
    ManagementFactory.getMemoryMXBean.getHeapMemoryUsage.getUsed

  def cpuNanos: Long = ManagementFactory.getOperatingSystemMXBean
    .asInstanceOf[com.sun.management.OperatingSystemMXBean]
    .getProcessCpuTime
