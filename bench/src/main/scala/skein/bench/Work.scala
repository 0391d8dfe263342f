package skein.bench

import java.lang.management.ManagementFactory

/** A piece of work for one thread: its number of steps, and a witness of their result.
  *
  * @param unit description of one step
  */
final case class Work(name: String, unit: String)(val of: Int => (Double, Double)):

  /** Runs the work once on each of `threads` threads simultaneously. */
  def run(threads: Int): Rate =
    val results = Array.ofDim[(Double, Double)](threads)
    val workers = Array.tabulate(threads)(id => Thread(() => results(id) = of(id)))
    val start   = System.nanoTime()
    val cpu     = Work.cpuNanos
    workers.foreach(_.start())
    workers.foreach(_.join())
    val (wallNanos, cpuNanos) = (System.nanoTime() - start, Work.cpuNanos - cpu)
    val steps                 = results.map(_._1).sum
    Rate(steps / wallNanos * 1e3, steps / cpuNanos * 1e3, results.map(_._2).sum / threads)

object Work:
  /** Processor time of this process, including its compiler's and collector's threads. */
  def cpuNanos: Long = ManagementFactory.getOperatingSystemMXBean match
    case sun: com.sun.management.OperatingSystemMXBean => sun.getProcessCpuTime
    case other => sys.error(s"expected the processor time of a process, got ${other.getClass}")

/** Millions of steps.
  *
  * @param byWall millions of steps per second of the clock
  * @param byCpu millions of steps per second of processor time, which other load on the machine affects less
  * @param witness a number computed from the result
  */
final case class Rate(byWall: Double, byCpu: Double, witness: Double):
  /** The better value of each field separately. */
  def best(other: Rate): Rate = Rate(byWall.max(other.byWall), byCpu.max(other.byCpu), witness)
