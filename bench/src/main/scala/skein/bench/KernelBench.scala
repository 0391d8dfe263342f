package skein.bench

import skein.rollout.*
import skein.units.Vector3
import skein.vehicle.{Quadrotor, Setpoint}

/** What does each step towards reality cost? Forward simulation beside the yardstick's work, scalar and by lanes, on one
  * thread and on all.
  *
  *   - `yardstick`: [[ChauffeurKernel]]; one agent-step is 0.1 s of one agent
  *   - `stream`: [[StreamDuelKernel]], the `stream` loop's full event timing over `vpn`, the reduced model; the same unit
  *   - `stream, scalar`: [[Rollout]] of the same
  *   - `quadrotor`: [[QuadrotorKernel]]; one vehicle-step is 3 ms of the complete cascade
  *   - `quadrotor, scalar`: [[Quadrotor]]; the same unit
  *
  * Rates are of the processor time that the threads used, so that other load on the machine disturbs them less, and per
  * second of the wall clock. Every row prints a witness. Run: `./sbtw "bench/runMain skein.bench.KernelBench"`.
  */
object KernelBench:
  private val model = Reduced(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  /** Work of one thread: how many steps it made, and a witness of their result. */
  private type Work = Int => (Double, Double)

  private val yardstick: Work = thread =>
    val blocks = 512
    val worlds = blocks * ChauffeurKernel.BLOCK
    (worlds * ChauffeurKernel.TICKS * 2.0, ChauffeurKernel().run(thread, blocks) / worlds)

  private val stream: Work = thread =>
    val batches = 64
    val worlds  = StreamDuelKernel.WORLDS
    val kernel  = StreamDuelKernel(Duel.paper, LoopTiming.Stream(), model)
    val sum     = (0 until batches).map: batch =>
      val keys = Array.tabulate(worlds)(i => WorldRandom.key(thread, 0, batch * worlds + i))
      kernel.fly(keys, Array.fill(worlds)(DelayTable.vpn), Array.fill(worlds)(1f), Array.fill(worlds)(8f), 1f)
      kernel.meanLast10s.sum.toDouble
    (batches * worlds * 600 * 2.0, sum.sum / (batches * worlds))

  private val streamScalar: Work = thread =>
    val episodes = 256
    val rollout  = Rollout(Duel.paper, LoopTiming.Stream(), DelayTable.vpn, model)
    val sum      = (0 until episodes).map(i => rollout.fly(WorldRandom.key(thread, 0, i)).meanLast10sM).sum
    (episodes * 600 * 2.0, sum / episodes)

  private val quadrotor: Work = _ =>
    val kernel = QuadrotorKernel()
    val steps  = 100_000
    for i <- 0 until QuadrotorKernel.VEHICLES do
      kernel.hover(i, Vector3(0, 0, -20))
      kernel.command(i, 10, 0, -20)
    kernel.fly(steps)
    (QuadrotorKernel.VEHICLES * steps.toDouble, kernel.velocityNed(0).x)

  private val quadrotorScalar: Work = _ =>
    val steps    = 2_000_000
    val state    = Quadrotor.AirSim.hovering(Vector3(0, 0, -20))
    val setpoint = Setpoint.velocityZ(10, 0, -20)
    for _ <- 1 to steps do Quadrotor.AirSim.step(state, setpoint)
    (steps.toDouble, state.vx)

  def main(args: Array[String]): Unit =
    val cores = Runtime.getRuntime.availableProcessors
    for
      (name, work) <- Seq(
        "yardstick"         -> yardstick,
        "stream"            -> stream,
        "stream, scalar"    -> streamScalar,
        "quadrotor"         -> quadrotor,
        "quadrotor, scalar" -> quadrotorScalar
      )
    do
      for _ <- 1 to 3 do run(work, 1)
      for threads <- Seq(1, cores) do
        val (byCpu, byWall, witness) = Seq.fill(3)(run(work, threads)).maxBy(_._1)
        println(
          f"$name%-18s threads $threads  $byCpu%7.1f M steps per processor second  $byWall%7.1f M per second  witness $witness%.4f"
        )

  private def run(work: Work, threads: Int): (Double, Double, Double) =
    val cpuNanos = Array.ofDim[Long](threads)
    val results  = Array.ofDim[(Double, Double)](threads)
    val timer    = java.lang.management.ManagementFactory.getThreadMXBean
    val workers  = Array.tabulate(threads)(id =>
      Thread: () =>
        val before = timer.getCurrentThreadCpuTime
        results(id) = work(id)
        cpuNanos(id) = timer.getCurrentThreadCpuTime - before
    )
    val start = System.nanoTime()
    workers.foreach(_.start())
    workers.foreach(_.join())
    val wallNanos = System.nanoTime() - start
    val steps     = results.map(_._1).sum
    (steps / cpuNanos.sum * 1e3, steps / wallNanos * 1e3, results.map(_._2).sum / threads)
