package skein.bench

import skein.forward.{DelayTable, Engagement, LoopTiming, Rollout}
import skein.scenario.PaperDuel
import skein.simd.WorldRandom

/** How does the rate of forward simulation grow with the size of a batch, the number of threads and the size
  * of a team? `stream` over `vpn`, 60 s, the reduced model; duels by [[skein.lanes.TeamBatch]], teams by
  * [[skein.forward.Rollout]]. Run: `./sbtw "bench/runMain skein.bench.Scaling"`.
  */
object Scaling:
  def main(args: Array[String]): Unit =
    val cores = Runtime.getRuntime.availableProcessors
    warmUp()
    println("| worlds of a call | per episode | threads | M agent-steps/s | witness |")
    println("|---|---|---|---|---|")
    for
      (worlds, perEpisode) <- Seq(16, 128, 1024, 8192).flatMap(n =>
        Seq(n -> 1, n -> 16, n -> 128, n -> 1024)
      )
      if worlds >= perEpisode
      threads <- 1 to cores
    do
      val row = measure(worlds, perEpisode, threads)
      println(f"| $worlds | $perEpisode | $threads | ${row.byWall}%.1f | ${row.witness}%.4f |")
    println()
    println("| pursuers and evaders, each | episodes | M agent-steps/s, scalar, one thread | witness |")
    println("|---|---|---|---|")
    for pairs <- Seq(1, 2, 4, 8, 16, 32) do
      val row = Seq.fill(3)(team(pairs)).reduce(_.best(_))
      println(f"| $pairs | ${episodes(pairs)} | ${row.byWall}%.2f | ${row.witness}%.4f |")

  private def episodes(pairs: Int) = (64 / pairs).max(4)

  /** A team in which every agent plays against the nearest of the other side. */
  private def team(pairs: Int): Rate =
    val rollout =
      Rollout(Engagement.of(PaperDuel(pairs).fleet), LoopTiming.Stream(), DelayTable.vpn, Works.model)
    def effortRad(episode: Int): Double =
      rollout.fly(WorldRandom.key(1, 0, episode))
      rollout.controllers.map(_.effortRad).sum
    val start = System.nanoTime()
    val sum   = (0 until episodes(pairs)).map(effortRad).sum
    Rate(episodes(pairs) * pairs * 1200 / ((System.nanoTime() - start) * 1e-3), 0, sum / episodes(pairs))

  private def warmUp(): Unit = for _ <- 1 to 3 do
    for perEpisode <- Seq(1, 128) do measure(2048, perEpisode, 1)

  /** The best of three, each of at least 100,000 agent-steps. Kernels are compiled before; timetables are
    * recomputed.
    */
  private def measure(worlds: Int, perEpisode: Int, threads: Int): Rate =
    val calls = (100_000 / (worlds * 1200) + 1).max(1)
    Seq.tabulate(3): round =>
      val batch   = Works.batch(LoopTiming.Stream(), threads)
      val start   = System.nanoTime()
      val witness = Seq.tabulate(calls): call =>
        val outcomes =
          batch.fly(Works.Candidates(worlds, perEpisode, DelayTable.vpn, round * 1000 + call))
        outcomes.values(0).map(_.toDouble).sum / worlds
      val seconds = (System.nanoTime() - start) * 1e-9
      Rate(calls * worlds * 1200 / seconds / 1e6, 0, witness.sum / calls)
    .reduce(_.best(_))
