package skein.bench

import java.lang.management.ManagementFactory

/** A piece of work for one thread: how many steps it made, and a witness of their result.
  *
  * @param unit
  *   what one step is
  */
final case class Work(name: String, unit: String)(val of: Int => (Double, Double)):

  /** On so many threads at once, once. */
  def run(threads: Int): Rate =
    val cpuNanos = Array.ofDim[Long](threads)
    val results  = Array.ofDim[(Double, Double)](threads)
    val timer    = ManagementFactory.getThreadMXBean
    val workers  = Array.tabulate(threads)(id =>
      Thread: () =>
        val before = timer.getCurrentThreadCpuTime
        results(id) = of(id)
        cpuNanos(id) = timer.getCurrentThreadCpuTime - before
    )
    val start = System.nanoTime()
    workers.foreach(_.start())
    workers.foreach(_.join())
    val wallNanos = System.nanoTime() - start
    val steps     = results.map(_._1).sum
    Rate(steps / wallNanos * 1e3, steps / cpuNanos.sum * 1e3, results.map(_._2).sum / threads)

/** Millions of steps.
  *
  * @param byWall
  *   per second of the clock
  * @param byCpu
  *   per second of processor time that the threads used: other load on the machine disturbs it less
  * @param witness
  *   that the work was done
  */
final case class Rate(byWall: Double, byCpu: Double, witness: Double):
  /** The better of both, each for itself. */
  def best(other: Rate): Rate = Rate(byWall.max(other.byWall), byCpu.max(other.byCpu), witness)
