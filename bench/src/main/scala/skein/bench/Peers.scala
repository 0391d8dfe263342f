package skein.bench

import java.nio.file.{Files, Path}
import scala.collection.mutable
import scala.sys.process.*

/** How fast is forward simulation compared with its peers? On one machine in one run: a hand-vectorised C
  * kernel of the yardstick's work, its Numba and JAX twins, and Skein's; the `stream` loop's full event
  * timing; the quadrotor compared with Crazyflow. All sides take turns, round after round, on one thread and
  * on all cores, so that other load affects all equally; the best round of each counts. Every row prints a
  * witness. `bench/peers` prepares the tools and runs this.
  *
  * Arguments: rounds, the compiled C program, Python with the twins' packages (`-`: without them), the folder
  * of the peers' programs.
  */
object Peers:
  def main(args: Array[String]): Unit =
    val Array(rounds, native, python, folder) = args
    val cores                                 = Runtime.getRuntime.availableProcessors
    val best                                  = mutable.LinkedHashMap.empty[(String, Int), Rate]

    def take(name: String, threads: Int)(rate: => Rate): Unit =
      val now = rate
      best.updateWith((name, threads))(before => Some(before.fold(now)(_.best(now)))): Unit
      println(f"$name%-44s threads $threads  ${describe(now)}  load ${load}")

    val ours = Seq(
      Works.yardstick,
      Works.yardstickScalar,
      Works.candidates,
      Works.singleWorlds,
      Works.streamScalar,
      Works.quadrotor,
      Works.quadrotorScalar,
      Works.networkByLanes,
      Works.networkScalar
    )
    for
      _    <- 1 to 3
      work <- ours
    do
      // On one thread and on all: code compiled for a single caller is recompiled when others call it.
      work.run(1): Unit
      work.run(cores)
    for
      round   <- 1 to rounds.toInt
      threads <- Seq(1, cores).distinct
    do
      println(s"round $round of $rounds")
      take("yardstick, C", threads)(inC(native, threads))
      for work <- ours do
        take(work.name, threads)(work.run(threads))
        // Measured once more in turns with its peer, because the ratio compares these two.
        if work == Works.yardstick then take("yardstick, C", threads)(inC(native, threads))
      if python != "-" then
        for (name, program, twin) <- Twins do
          inPython(python, Path.of(folder).resolve(program), twin, threads) match
            case Right(rate)  => take(name, threads)(rate)
            case Left(reason) => println(s"$name threads $threads failed: $reason")
    println(table(best, cores))

  private val Twins = Seq(
    ("yardstick, Numba", "peers.py", "numba"),
    ("yardstick, JAX", "peers.py", "jax"),
    ("Crazyflow, first principles, attitude control", "crazyflow.py", "10000")
  )

  private def describe(rate: Rate) =
    f"${rate.byWall}%8.1f M/s  ${rate.byCpu}%8.1f M per processor second  witness ${rate.witness}%.4f"

  private def load: String = Files.readString(Path.of("/proc/loadavg")).split(' ').head

  private val InC    = """(?s).*rate ([\d.]+) M/s +witness ([\d.]+).*""".r
  private val Blocks = 2048

  private def inC(native: String, threads: Int): Rate =
    val cpu = new StringBuilder
    val run = Seq("bash", "-c", s"TIMEFORMAT=%U; time '$native' $threads ${threads * Blocks}")
    run.!!(ProcessLogger(_ => (), line => cpu.append(line): Unit)) match
      case InC(rate, witness) =>
        val steps = threads * Blocks * ChauffeurKernel.BLOCK * ChauffeurKernel.TICKS * 2e-6
        Rate(rate.toDouble, steps / cpu.toString.toDouble, witness.toDouble)
      case other => sys.error(s"expected a line with rate and witness, got: $other")

  private val InPython = """(?s).*rate ([\d.]+) cpu ([\d.]+) witness ([-\d.]+).*""".r

  /** Runs a Python twin on `threads` cores. */
  private def inPython(python: String, program: Path, twin: String, threads: Int): Either[String, Rate] =
    val errors  = new StringBuilder
    val command = Seq("taskset", "-c", s"0-${threads - 1}", python, program.toString, twin)
    val output  = new StringBuilder
    val exit    =
      Process(command, None, "NUMBA_NUM_THREADS" -> threads.toString, "JAX_PLATFORMS" -> "cpu")
        .!(ProcessLogger(
          line => output.append(line).append('\n'): Unit,
          line => errors.append(line).append('\n'): Unit
        ))
    output.toString match
      case InPython(rate, cpu, witness) if exit == 0 =>
        Right(Rate(rate.toDouble, cpu.toDouble, witness.toDouble))
      case _ => Left(s"exit $exit; ${errors.toString.linesIterator.toSeq.lastOption.getOrElse("no output")}")

  private def table(best: collection.Map[(String, Int), Rate], cores: Int): String =
    def peerOf(name: String) =
      if name.startsWith("quadrotor") then "Crazyflow, first principles, attitude control" else "yardstick, C"
    val rows =
      for ((name, threads), rate) <- best.toVector.sortBy { case ((name, threads), _) =>
          (threads, name)
        }
      yield
        val peer                      = best.get((peerOf(name), threads)).filter(_ => name != peerOf(name))
        def ratio(of: Rate => Double) = peer.fold("")(p => f"${of(rate) / of(p)}%.2f")
        f"| $name | $threads | ${rate.byWall}%.1f | ${ratio(_.byWall)} | " +
          f"${rate.byCpu}%.1f | ${ratio(_.byCpu)} | ${rate.witness}%.4f |"
    def over(name: String) =
      for
        one <- best.get((name, 1))
        all <- best.get((name, cores))
      yield f"$name: $cores threads over 1: ${all.byWall / one.byWall}%.2f"
    val others =
      for
        twin <- Seq("yardstick, Numba", "yardstick, JAX")
        peer <- best.get((twin, cores))
        own  <- best.get((Works.yardstick.name, cores))
      yield f"${Works.yardstick.name} over $twin on $cores threads: " +
        f"${own.byWall / peer.byWall}%.1f by the clock, ${own.byCpu / peer.byCpu}%.1f by processor time"
    (Seq(
      "| work | threads | M/s | to its peer | M per processor second | to its peer | witness |",
      "|---|---|---|---|---|---|---|"
    ) ++ rows ++ Seq("") ++ over("yardstick, C") ++ over(Works.yardstick.name) ++ others).mkString("\n")
