package skein.bench

import skein.forward.{DelayTable, LoopTiming}
import skein.lanes.{TeamCandidate, TeamWorlds}
import skein.lanes.plant.LaneQuadrotors
import skein.optimise.LatencyBudget
import skein.simd.WorldRandom

/** The target figures of forward simulation, on all cores, each with a witness. Stated by the clock, and in
  * processor time over the number of cores: both agree on an idle machine. Run `./sbtw "bench/runMain
  * skein.bench.Figures"`.
  */
object Figures:
  private val cores = Runtime.getRuntime.availableProcessors

  def main(args: Array[String]): Unit =
    println(s"$cores cores")
    for _ <- 1 to 3 do
      Works.yardstick.run(1)
      Works.quadrotor.run(1)
      candidates(20_000, 100)
      budget(20_000)

    val blocks = 200_000_000 / (ChauffeurKernel.BLOCK * ChauffeurKernel.TICKS * 2) / cores / 4 * 4
    val steps  = blocks.toDouble * cores * ChauffeurKernel.BLOCK * ChauffeurKernel.TICKS * 2
    val share  = Work("yardstick", ""): thread =>
      (steps / cores, ChauffeurKernel().run(thread, blocks) / (blocks * ChauffeurKernel.BLOCK))
    show(
      f"${steps / 1e6}%.0f M agent-steps of the yardstick, well under a second",
      steps,
      5
    )(share.run(cores).witness)

    val vehicleSteps = cores * 50_000.0 * LaneQuadrotors.VEHICLES
    show("quadrotor with its controller, at least 80 M vehicle-steps/s", vehicleSteps, 5)(
      Works.quadrotor.run(cores).witness
    )
    for episodes <- Seq(1, 100) do
      val each = 1_000_000 / episodes
      show(
        s"1,000,000 evaluations of 60 s, stream over vpn, $each " +
          s"candidates on each of $episodes episodes, within 15 s",
        1.2e9
      )(
        candidates(1_000_000, episodes)
      )
    show(
      "800,000 episodes of 60 s, stream, 1,000 over each of 800 links (a budget's map), within 15 s",
      9.6e8
    )(
      budget(800_000)
    )

  /** Prints the best rate of `tries` tries. */
  private def show(what: String, steps: Double, tries: Int = 1)(work: => Double): Unit =
    val runs = Seq.fill(tries):
      val (start, cpu) = (System.nanoTime(), Work.cpuNanos)
      val witness      = work
      ((System.nanoTime() - start) * 1e-9, (Work.cpuNanos - cpu) * 1e-9 / cores, witness)
    val (clock, cpu) = (runs.map(_._1).min, runs.map(_._2).min)
    println(
      f"$what: $clock%.2f s by the clock, ${steps / clock / 1e6}%.0f M steps/s; $cpu%.2f s of " +
        f"each processor, ${steps / cpu / 1e6}%.0f M steps/s; witness ${runs.head._3}%.4f"
    )

  private def candidates(evaluations: Int, episodes: Int): Double =
    val worlds   = Works.Candidates(evaluations, evaluations / episodes, DelayTable.vpn, 1)
    val outcomes = Works.batch(LoopTiming.Stream(), cores).fly(worlds)
    outcomes.values(0).map(_.toDouble).sum / evaluations

  /** Links with mean round trips from 20 to 215 ms and jitters from 0 to 38 ms. */
  private val links: Vector[DelayTable] = Vector.tabulate(800): cell =>
    DelayTable.of(LatencyBudget.link(
      20.0 + cell % 40 * 5,
      cell / 40 * 2.0
    ).getOrElse(LatencyBudget.link(20, 10).get))

  private def budget(episodes: Int): Double =
    val worlds = new TeamWorlds:
      private val all                          = Works.Candidates(1000, 1, DelayTable.vpn, 1)
      def size: Int                            = episodes
      def key(world: Int): Int                 = WorldRandom.key(1, 0, world % 1000)
      def link(world: Int): DelayTable         = links(world / 1000)
      def candidate(world: Int): TeamCandidate = all.candidate(world)
    Works.batch(LoopTiming.Stream(), cores).fly(worlds).values(0).map(_.toDouble).sum / episodes
