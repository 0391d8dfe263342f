package skein.bench

import java.nio.file.{Files, Path}
import scala.sys.process.*

/** How fast is our SIMD kernel beside a hand-vectorised C kernel of the same work, on one core and on all?
  *
  * Compiles `yardstick/chauffeur.c` with gcc and runs both alternately in one run, so that other load on the machine
  * meets both alike. One agent-step is: draw an age, interpolate both positions, decide, one exact lag step, distance.
  * Every row prints the witness (mean of smallest plus mean distance), which must agree.
  *
  * Run from the `bench` folder or the repository's root: `./sbtw "bench/runMain skein.bench.ChauffeurBench"`; an
  * optional argument gives the rounds (default 10, about a second each).
  */
object ChauffeurBench:

  final case class Row(threads: Int, rate: Double, witness: Double)

  def main(args: Array[String]): Unit =
    val rounds = args.headOption.fold(10)(_.toInt)
    val cores  = Runtime.getRuntime.availableProcessors
    val native = compile()
    for _ <- 1 to 20 do ours(1, WarmUpBlocks)
    val rows =
      for
        _       <- 1 to rounds
        threads <- Seq(1, cores)
        row     <- Seq("C" -> inC(native, threads), "Skein" -> ours(threads, BlocksPerThread))
      yield
        println(f"${row._1}%-6s ${describe(row._2)}")
        row
    println("best of the rounds")
    def best(name: String, threads: Int) =
      rows.collect { case (`name`, row) if row.threads == threads => row }.maxBy(_.rate)
    for threads <- Seq(1, cores) do
      val (c, skein) = (best("C", threads), best("Skein", threads))
      println(f"C      ${describe(c)}")
      println(f"Skein  ${describe(skein)}  ratio to C ${skein.rate / c.rate}%.2f")
    println(f"Skein on $cores threads over 1: ${best("Skein", cores).rate / best("Skein", 1).rate}%.2f")

  private val BlocksPerThread = 1024
  private val WarmUpBlocks    = 64

  private def describe(row: Row) =
    f"threads ${row.threads}  ${row.rate}%7.1f M agent-steps/s  witness ${row.witness}%.6f"

  def ours(threads: Int, blocksPerThread: Int): Row =
    val sums    = Array.ofDim[Double](threads)
    val workers = Array.tabulate(threads)(id =>
      Thread(() => sums(id) = ChauffeurKernel().run(id, blocksPerThread))
    )
    val start = System.nanoTime()
    workers.foreach(_.start())
    workers.foreach(_.join())
    val seconds = (System.nanoTime() - start) * 1e-9
    val worlds  = threads.toDouble * blocksPerThread * ChauffeurKernel.BLOCK
    Row(threads, worlds * ChauffeurKernel.TICKS * 2 / seconds / 1e6, sums.sum / worlds)

  private val Printed = """(?s).*rate ([\d.]+) M/s +witness ([\d.]+).*""".r

  private def inC(native: Path, threads: Int): Row =
    Seq(native.toString, threads.toString, (threads * BlocksPerThread).toString).!! match
      case Printed(rate, witness) => Row(threads, rate.toDouble, witness.toDouble)
      case other                  => sys.error(s"expected a line with rate and witness, got: $other")

  private def compile(): Path =
    val source = Seq("bench/yardstick/chauffeur.c", "yardstick/chauffeur.c")
      .map(Path.of(_))
      .find(Files.exists(_))
      .getOrElse(sys.error("yardstick/chauffeur.c not found: run from the repository's root or from bench/"))
    val binary = Files.createTempDirectory("yardstick").resolve("chauffeur")
    val flags  = Seq("-O3", "-march=native", "-ffast-math", "-mprefer-vector-width=512", "-fopenmp-simd")
    val exit   = (Seq("gcc") ++ flags ++ Seq(source.toString, "-o", binary.toString, "-lm", "-lpthread")).!
    if exit != 0 then sys.error(s"gcc failed with exit code $exit")
    binary
