package skein.lanes

import java.lang.management.ManagementFactory
import skein.forward.*
import skein.lanes.score.Judged
import skein.scenario.Reduction
import skein.simd.WorldRandom
import skein.vehicle.TiltModel

/** Measures the speed of a team in three dimensions: [[Tower]], `stream` over `vpn`, 60 s. Simulates 200
  * candidates × 200 episodes on all cores, and measures processor time with SIMD and by the scalar engine,
  * with a witness of both. Run: `forward/Test/runMain skein.lanes.towerRates`.
  */
@main def towerRates(): Unit =
  val system =
    ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]
  val (model, timing)        = (SpatialResponse(TiltModel.AirSim), LoopTiming.Stream())
  def candidate(number: Int) =
    val tower = Tower(radiusM = 6 + 0.02 * number, keepM = 8 + 0.02 * number)
    TeamCandidate(
      Engagement.inSpace(tower.fleet, 60),
      Vector(Judged(Tower.Kept(4), Reduction.Mean, 0), Judged(Tower.ApartInSpace, Reduction.Least, 0))
    )
  val candidates = Vector.tabulate(200)(candidate)
  final class Worlds(episodes: Int, shared: Boolean) extends TeamWorlds:
    def size: Int                       = candidates.size * episodes
    override def shareEpisodes: Boolean = shared
    def key(world: Int): Int            =
      WorldRandom.key(1, 0, if shared then world / candidates.size else world)
    def link(world: Int): Delays             = DelayTable.vpn
    def candidate(world: Int): TeamCandidate = candidates(world % candidates.size)
  val steps = 5 * 600.0
  for shared <- Seq(true, false) do
    val batch = TeamBatch(timing, model, 1)
    println(batch.engine(candidates.head, shared, Seq(DelayTable.vpn)).text)
    val worlds = Worlds(2, shared)
    for _ <- 1 to 6 do batch.fly(worlds): Unit
    val (rate, witness) = Vector.fill(3) {
      val before = system.getProcessCpuTime
      val values = batch.fly(worlds).values
      (
        worlds.size * steps * 1e3 / (system.getProcessCpuTime - before),
        values(0).map(_.toDouble).sum / worlds.size
      )
    }.maxBy(_._1)
    val scalar = ScalarTeam(timing, model)
    val some   = Vector.range(0, 8)
    for _ <- 1 to 2 do
      some.foreach(world => scalar.fly(worlds.candidate(world), DelayTable.vpn, worlds.key(world)))
    val before = system.getProcessCpuTime
    val truth  = some.map(world => scalar.fly(worlds.candidate(world), DelayTable.vpn, worlds.key(world))(0))
    val slow   = some.size * steps * 1e3 / (system.getProcessCpuTime - before)
    val same   = batch.fly(worlds).values(0).take(8)
    println(
      f"${if shared then "shared" else "own"} delays: SIMD $rate%.2f M agent-steps/s, scalar $slow%.3f, ratio ${rate / slow}%.0f; " +
        f"mean distance kept $witness%.4f m; of eight worlds ${same.map(_.toDouble).sum / 8}%.4f and ${truth.sum / 8}%.4f"
    )
  val whole = System.nanoTime()
  val all   = TeamBatch(timing, model).fly(Worlds(200, shared = true))
  println(f"200 candidates × 200 episodes: ${(System.nanoTime() - whole) * 1e-9}%.1f s, ${all.flown} worlds")
