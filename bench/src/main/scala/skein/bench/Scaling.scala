package skein.bench

import skein.rollout.*

/** How does the rate of forward simulation grow with the size of a batch and the number of threads? `stream` over `vpn`,
  * 60 s, the reduced model; all by [[skein.rollout.DuelBatch]]. Run: `./sbtw "bench/runMain skein.bench.Scaling"`.
  */
object Scaling:
  def main(args: Array[String]): Unit =
    val cores = Runtime.getRuntime.availableProcessors
    warmUp()
    println("| worlds of a call | per episode | threads | M agent-steps/s | witness |")
    println("|---|---|---|---|---|")
    for
      (worlds, perEpisode) <- Seq(16, 128, 1024, 8192, 65536).flatMap(n =>
        Seq(n -> 1, n -> 16, n -> 128, n -> 1024)
      )
      if worlds >= perEpisode
      threads <- 1 to cores
    do
      val row = measure(worlds, perEpisode, threads)
      println(f"| $worlds | $perEpisode | $threads | ${row.byWall}%.1f | ${row.witness}%.4f |")

  private def warmUp(): Unit = for _ <- 1 to 3 do
    for perEpisode <- Seq(1, 128) do measure(2048, perEpisode, 1)

  /** The best of three, each of at least 100,000 agent-steps. The kernels stand ready; timetables are made anew. */
  private def measure(worlds: Int, perEpisode: Int, threads: Int): Rate =
    val calls = (100_000 / (worlds * 1200) + 1).max(1)
    Seq.tabulate(3): round =>
      val batch   = Works.batch(LoopTiming.Stream(), threads)
      val start   = System.nanoTime()
      val witness = Seq.tabulate(calls): call =>
        val outcomes =
          batch.fly(Works.Candidates(worlds, perEpisode, DelayTable.vpn, round * 1000 + call))
        outcomes.meanLast10sM.map(_.toDouble).sum / worlds
      val seconds = (System.nanoTime() - start) * 1e-9
      Rate(calls * worlds * 1200 / seconds / 1e6, 0, witness.sum / calls)
    .reduce(_.best(_))
