package skein.cli

import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*
import skein.blocks.Ledger
import skein.optimise.Evaluator
import skein.policy.Role
import skein.scenario.Scenarios
import skein.search.*
import skein.settings.PolicyFile
import skein.signal.SplitMix64

/** The overhead of workers: candidates evaluated by two processes of one thread each, against this process
  * with two threads, in turns: `./sbtw "cli/Test/runMain skein.cli.clusterOverhead 9 250 DIR"`. Both results
  * must have equal bits.
  *
  * @param blockMs approximate time of a block on one core
  */
@main def clusterOverhead(pairs: Int, blockMs: Int, out: String): Unit =
  given Scenarios = Scenarios.ours
  val question    = SearchQuestion(
    "lead-pursuit",
    "pursuer",
    "last10s",
    "random",
    Conditions("stream", "reduced", 100, 20),
    "vpn",
    PolicyFile.paperOf(Role.Evader).text,
    candidates = 1000,
    episodes = 20,
    population = 40,
    seed = 1,
    None
  )
  val ready    = question.setup.fold(reason => throw IllegalArgumentException(reason), identity)
  val episodes = 0 until 16
  var seed     = 0L

  /** New candidates for each call, since those in the ledger are not computed again. */
  def candidates(count: Int): Vector[Vector[Double]] =
    seed += 1
    val random = SplitMix64(seed)
    Vector.fill(count)(
      ready.space.axes.map(axis => axis.least + random.nextDouble() * (axis.most - axis.least)).toVector
    )

  /** Processor time of this process and its workers so far, s. */
  def cpuS =
    val workers = ProcessHandle.current().children().toList.asScala
    val theirs  = workers.flatMap(_.info().totalCpuDuration().toScala).map(_.toNanos).sum
    val own     = ManagementFactory.getOperatingSystemMXBean
      .asInstanceOf[com.sun.management.OperatingSystemMXBean]
      .getProcessCpuTime
    (own + theirs) * 1e-9

  def timed(by: Evaluator, of: Vector[Vector[Double]]) =
    val (begun, cpuFrom) = (System.nanoTime(), cpuS)
    val tallies          = by.tallies(of, episodes)
    (tallies = tallies, s = (System.nanoTime() - begun) * 1e-9, cpuS = cpuS - cpuFrom)

  val one   = ready.judges(1)(Judge.Candidates)
  val two   = ready.judges(2)(Judge.Candidates)
  val group = 2048
  for _ <- 1 to 3 do timed(two, candidates(group)): Unit
  // The best of a few: other load on the machine lowers the rate.
  val rate  = Vector.fill(5)(group * episodes.size / timed(one, candidates(group)).s).max
  val block = (rate * blockMs * 1e-3).round.toInt.max(episodes.size)
  // Forty blocks of each worker, so that the last ones matter little.
  val count  = (80.0 * block / episodes.size).round.toInt
  val folder = Files.createDirectories(Path.of(out))
  Files.deleteIfExists(folder.resolve(Ledger.Name)): Unit
  println(
    f"one core flies $rate%,.0f episodes a second; blocks of $block%,d; calls of ${count * episodes.size}%,d"
  )

  val posed   = QuestionKind.Search.of(VerifiedQuestion.bytes(ready))
  val options =
    ClusterOptions.Checked(workers = 2, ClusterOptions.Loopback, Some(block), None)
  val done = ClusterRun.using(options, "skein.cli.Main", posed, folder, threads = 2, Shown(false)): run =>
    val elsewhere = ClusterEvaluator(run, Judge.Candidates, block, _ => ())
    for _ <- 1 to 2 do timed(elsewhere, candidates(count)): Unit
    val ratios = Vector.range(1, pairs + 1).map: pair =>
      val asked = candidates(count)
      val order = if pair % 2 == 0 then Seq(two, elsewhere) else Seq(elsewhere, two)
      val taken = order.map(by => by -> timed(by, asked)).toMap
      val here  = taken(two)
      val there = taken(elsewhere)
      require(here.tallies == there.tallies, s"pair $pair: other bits")
      println(
        f"pair $pair: here ${here.s}%.2f s (${here.cpuS}%.2f s of the processor), two workers " +
          f"${there.s}%.2f s (${there.cpuS}%.2f s): ${here.s / there.s}%.3f of the rate"
      )
      (rate = here.s / there.s, cpu = here.cpuS / there.cpuS)
    def told(of: Seq[Double]) =
      f"${of.sorted.apply(of.size / 2)}%.3f (median of ${of.size}, ${of.min}%.3f to ${of.max}%.3f)"
    println(s"two workers fly ${told(ratios.map(_.rate))} of this process's rate")
    println(s"and for the same processor's time ${told(ratios.map(_.cpu))} as much")
    Right(())
  done.left.foreach(reason => throw IllegalStateException(reason))
