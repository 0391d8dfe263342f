package skein.lanes

import java.lang.management.ManagementFactory
import skein.forward.*
import skein.lanes.score.Judged
import skein.scenario.{Convoy, Reduction}
import skein.simd.WorldRandom
import skein.vehicle.{ReducedModel, TiltModel}

/** Measures the speed of a team in three dimensions, [[Tower]]. Run: `forward/Test/runMain
  * skein.lanes.towerRates`.
  */
@main def towerRates(): Unit = TeamRates.print(SpatialResponse(TiltModel.AirSim)): number =>
  TeamCandidate(
    Engagement.inSpace(Tower(radiusM = 6 + 0.02 * number, keepM = 8 + 0.02 * number).fleet, 60),
    Vector(Judged(Tower.Kept(4), Reduction.Mean, 0), Judged(Tower.ApartInSpace, Reduction.Least, 0))
  )

/** Measures the speed of cars and drones in one team, [[Convoy]]. Run: `forward/Test/runMain
  * skein.lanes.convoyRates`.
  */
@main def convoyRates(): Unit = TeamRates.print(PlantResponse(ReducedModel.airSimAt(10))): number =>
  val convoy = Convoy(gapM = 8 + 0.02 * number, carMps = 5 + 0.01 * number)
  TeamCandidate(
    Engagement.inSpace(convoy.fleet, 60),
    convoy.measures.flatMap(_.reduced).map(by => Judged(by.quantity, by.reduction, 10))
  )

/** Measures the speed of teams, `stream` over `vpn`, 60 s. */
object TeamRates:
  private val Some = 64

  /** Rounds before measuring, until the compilers are done. */
  private val WarmUp = 20

  /** Measures processor time with SIMD and by the scalar engine in turns, with a witness of both, then
    * simulates 200 candidates × 200 episodes on all cores.
    */
  def print(model: VelocityResponse)(candidate: Int => TeamCandidate): Unit =
    val system =
      ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]
    val timing     = LoopTiming.Stream()
    val candidates = Vector.tabulate(200)(candidate)
    val agentSteps = candidates(0).engagement.agents.size * 600.0
    final class Worlds(episodes: Int, shared: Boolean) extends TeamWorlds:
      def size: Int                       = candidates.size * episodes
      override def shareEpisodes: Boolean = shared
      def key(world: Int): Int            =
        WorldRandom.key(1, 0, if shared then world / candidates.size else world)
      def link(world: Int): Delays             = DelayTable.vpn
      def candidate(world: Int): TeamCandidate = candidates(world % candidates.size)
    for shared <- Seq(true, false) do
      val batch = TeamBatch(timing, model, 1)
      println(batch.engine(candidates.head, shared, Seq(DelayTable.vpn)).text)
      val worlds = Worlds(10, shared)
      val scalar = ScalarTeam(timing, model)
      def fast() = batch.fly(worlds).values(0).map(_.toDouble).toVector
      def slow() = Vector.tabulate(Some)(world =>
        scalar.fly(worlds.candidate(world), DelayTable.vpn, worlds.key(world))(0)
      )
      def rate(numbers: () => Vector[Double]): Double =
        val before = system.getProcessCpuTime
        numbers().size * agentSteps * 1e3 / (system.getProcessCpuTime - before)
      for _ <- 1 to WarmUp do
        fast(): Unit
        slow(): Unit
      val turns          = Vector.fill(9)((rate(() => fast()), rate(() => slow()))).sortBy(_ / _)
      val (by, byScalar) = turns(turns.size / 2)
      val (came, truth)  = (fast(), slow())
      println(
        f"${if shared then "shared" else "own"} delays: SIMD $by%.2f M agent-steps/s, scalar $byScalar%.3f, ratio ${by / byScalar}%.0f " +
          f"(${turns.head._1 / turns.head._2}%.0f to ${turns.last._1 / turns.last._2}%.0f in ${turns.size} turns); mean of the first measure " +
          f"${came.sum / came.size}%.4f; of $Some worlds ${came.take(Some).sum / Some}%.5f and ${truth.sum / Some}%.5f"
      )
    for shared <- Seq(true, false) do
      val (whole, processor) = (System.nanoTime(), system.getProcessCpuTime)
      val all                = TeamBatch(timing, model).fly(Worlds(200, shared))
      println(
        f"200 candidates × 200 episodes, ${if shared then "shared" else "own"} delays: ${(System.nanoTime() - whole) * 1e-9}%.1f s, " +
          f"${(system.getProcessCpuTime - processor) * 1e-9}%.1f s of processors, ${all.flown} worlds"
      )
