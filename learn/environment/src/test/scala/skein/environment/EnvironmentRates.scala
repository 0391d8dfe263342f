package skein.environment

import java.lang.management.ManagementFactory
import java.nio.{ByteBuffer, ByteOrder}
import scala.util.hashing.MurmurHash3
import skein.scenario.Scenarios

/** How fast are environments, and what do they come to? Steps of one vehicle's decision a second of processor
  * time, times the vehicles of a world, for `surround` and the duel over several links, with a digest of all
  * observations, rewards and ends as a witness. Run: `environment/Test/runMain
  * skein.environment.environmentRates 1024 400`.
  */
@main def environmentRates(count: Int, steps: Int): Unit =
  val surround = EnvironmentSettings(scenario = "surround", set = Map("vehicles" -> "6"), startWithinM = (0, 5))
  val duel     = EnvironmentSettings(startWithinM = (3, 9), episodeS = 20, captureRadiusM = 3)
  val all      = Seq(
    (2, "duel", EnvironmentSettings()),
    (2, "duel, captures", duel),
    (2, "duel, captures, evader", duel.copy(learners = "evader")),
    (2, "duel, evader by a rate", duel.copy(learners = "evader", evaderRateRadPerS = 2)),
    (2, "duel, both", duel.copy(learners = "both")),
    (2, "duel, predictive", duel.copy(loop = "predictive")),
    (2, "duel, paused, both", duel.copy(loop = "paused", link = "none", learners = "both")),
    (2, "duel, drag", duel.copy(plant = "drag")),
    (2, "duel, quadrotor", duel.copy(plant = "quadrotor")),
    (6, "surround", surround)
  )
  for (vehicles, name, settings) <- all do
    val fewer = if name == "surround" then (count / 64).max(1) else count
    RateRow.print(vehicles, name, settings, fewer, steps)(using Scenarios.ours)

private[environment] object RateRow:
  private val system =
    ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]

  /** Prints a row: the rate, the digest, and the first environment's mean distance. */
  def print(vehicles: Int, name: String, settings: EnvironmentSettings, count: Int, steps: Int)(using
      Scenarios
  ): Unit =
    val agents  = if settings.learners == "both" then 2 else 1
    val block   = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(agents, count)).order(ByteOrder.nativeOrder)
    val batch   = EnvironmentBatch.of(settings, count, Autoreset.SameStep, block).fold(sys.error(_), identity)
    val buffers = EnvironmentBuffers(block, agents, count)
    def act(step: Int): Unit =
      for agent <- 0 until agents; number <- 0 until count do
        buffers.actions.put(agent * count + number, StrictMath.sin(step * 0.3 + number + agent).toFloat): Unit
    def restart(): Unit = batch.reset(Array.tabulate(count)(_ + 7L))
    restart()
    var digest = 0
    for step <- 0 until 300 do
      act(step)
      batch.step()
      for i <- 0 until agents * 9 * count do
        digest = MurmurHash3.mix(digest, java.lang.Float.floatToIntBits(buffers.observations.get(i)))
      for i <- 0 until agents * count do
        digest = MurmurHash3.mix(digest, java.lang.Float.floatToIntBits(buffers.rewards.get(i)))
      for i <- 0 until count do
        digest = MurmurHash3.mix(digest, buffers.terminations.get(i) * 2 + buffers.truncations.get(i))
    val rates = Vector.fill(5):
      restart()
      val before = system.getProcessCpuTime
      for _ <- 0 until steps do batch.step()
      count.toDouble * steps * 1e3 / (system.getProcessCpuTime - before)
    val best = rates.max
    println(
      f"$name%-24s $best%8.3f M steps/s, ${best * vehicles}%8.3f M/s per vehicle, median ${rates.sorted.apply(2)}%8.3f; digest $digest%08x; ${batch.engine}"
    )
    batch.close()
