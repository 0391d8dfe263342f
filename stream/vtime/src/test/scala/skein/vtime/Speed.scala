package skein.vtime

import java.lang.management.ManagementFactory
import scala.concurrent.Future
import scala.concurrent.duration.*

/** Speed of virtual time: starting and ending a system, and seconds of [[SampleGraph]] per second of the
  * loop's processor time, which a busy machine does not distort. The digest is the witness.
  */
@main def virtualTimeSpeed(): Unit =
  val threads = ManagementFactory.getThreadMXBean

  def seconds[A](body: => A): Double =
    val start = threads.getCurrentThreadCpuTime
    body: Unit
    (threads.getCurrentThreadCpuTime - start) / 1e9

  val cold = seconds(VirtualTime.run(1)(_ => Future.unit))
  println(f"first run of an empty system: ${cold * 1e3}%.0f ms")
  for _ <- 1 to 4 do
    val empty = seconds((1 to 200).foreach(_ => VirtualTime.run(1)(_ => Future.unit)))
    println(f"empty system, start to end: ${empty / 200 * 1e3}%.2f ms")
  val duration = 60.seconds
  for _ <- 1 to 4; graphs <- Seq(1, 100) do
    val repeats = if graphs == 1 then 20 else 1
    var witness = ""
    val took    = seconds((1 to repeats).foreach(_ => witness = SampleGraph.digest(1, graphs, duration)))
    println(
      f"$graphs%3d graphs: " +
        f"${duration.toSeconds * graphs * repeats / took}%.0f graph-seconds per second, ${witness.take(12)}"
    )
