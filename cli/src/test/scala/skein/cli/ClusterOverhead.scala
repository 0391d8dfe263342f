package skein.cli

import java.nio.file.{Files, Path}
import skein.blocks.Ledger
import skein.optimise.Evaluator
import skein.policy.Role
import skein.scenario.Scenarios
import skein.search.*
import skein.settings.PolicyFile
import skein.signal.SplitMix64

/** What others cost: candidates judged by two processes of one thread each, against this process with two threads, in
  * turns: `./sbtw "cli/Test/runMain skein.cli.clusterOverhead 9 250 DIR"`. Both must come to the same bits.
  *
  * @param blockMs
  *   that a block takes one core, about
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

  /** Others each time, since what the ledger has is not computed again. */
  def candidates(count: Int): Vector[Vector[Double]] =
    seed += 1
    val random = SplitMix64(seed)
    Vector.fill(count)(
      ready.space.axes.map(axis => axis.least + random.nextDouble() * (axis.most - axis.least)).toVector
    )

  def seconds(by: Evaluator, of: Vector[Vector[Double]]) =
    val begun   = System.nanoTime()
    val tallies = by.tallies(of, episodes)
    (tallies, (System.nanoTime() - begun) * 1e-9)

  val one   = ready.judges(1)(Judge.Candidates)
  val two   = ready.judges(2)(Judge.Candidates)
  val group = 2048
  for _ <- 1 to 3 do seconds(two, candidates(group)): Unit
  // The best of a few: whoever else is at work makes it less.
  val rate  = Vector.fill(5)(group * episodes.size / seconds(one, candidates(group))._2).max
  val block = (rate * blockMs * 1e-3).round.toInt.max(episodes.size)
  // Forty blocks of each worker, so that the last ones weigh little.
  val count  = (80.0 * block / episodes.size).round.toInt
  val folder = Files.createDirectories(Path.of(out))
  Files.deleteIfExists(folder.resolve(Ledger.Name)): Unit
  println(
    f"one core flies $rate%,.0f episodes a second; blocks of $block%,d; calls of ${count * episodes.size}%,d"
  )

  val posed   = Questions.search(VerifiedQuestion.bytes(question, ready))
  val options = ClusterOptions.Checked(workers = 2, ClusterOptions.Loopback, Some(block), None, None)
  val done    = ClusterRun.using(options, "skein.cli.Main", posed, folder, threads = 2, Shown(false)): run =>
    val elsewhere = ClusterEvaluator(run, Judge.Candidates, block, _ => ())
    for _ <- 1 to 2 do seconds(elsewhere, candidates(count)): Unit
    val ratios =
      for pair <- 1 to pairs yield
        val asked           = candidates(count)
        val order           = if pair % 2 == 0 then Seq(two, elsewhere) else Seq(elsewhere, two)
        val taken           = order.map(by => by -> seconds(by, asked)).toMap
        val (here, hereS)   = taken(two)
        val (there, others) = taken(elsewhere)
        require(here == there, s"pair $pair: other bits")
        println(
          f"pair $pair: here $hereS%.2f s, two workers $others%.2f s: ${hereS / others}%.3f of the rate"
        )
        hereS / others
    val sorted = ratios.sorted
    println(
      f"two workers fly ${sorted(sorted.size / 2)}%.3f of this process's rate (median of $pairs, ${sorted.head}%.3f to ${sorted.last}%.3f)"
    )
    Right(())
  done.left.foreach(reason => throw IllegalStateException(reason))
