package skein.environment

import java.lang.management.ManagementFactory
import java.nio.{ByteBuffer, ByteOrder}
import scala.util.hashing.MurmurHash3
import skein.scenario.{ScenarioKind, Scenarios}

/** How fast are environments, and what do they come to? Steps a second of processor time, with a digest of all
  * rewards and ends of 300 steps as a witness. Run: `environment/Test/runMain
  * skein.environment.environmentRates 4096 2000 duel`; the last words choose rows.
  */
@main def environmentRates(count: Int, steps: Int, rows: String*): Unit =
  val duel     = EnvironmentSettings(startWithinM = (3, 9), episodeS = 20, captureRadiusM = 3)
  val surround = EnvironmentSettings(scenario = "surround", startWithinM = (0, 5))
  val all      = Seq(
    (2, "duel", EnvironmentSettings()),
    (2, "captures", duel),
    (2, "evader", duel.copy(learners = "evader")),
    (2, "both", duel.copy(learners = "both")),
    (2, "predictive", duel.copy(loop = "predictive")),
    (2, "paused", duel.copy(loop = "paused", link = "none", learners = "both")),
    (2, "drag", duel.copy(plant = "drag")),
    (2, "quadrotor", duel.copy(plant = "quadrotor")),
    (6, "surround", surround),
    (5, "tower", EnvironmentSettings(scenario = "tower", learners = "keeper", objective = "kept"))
  )
  for (vehicles, name, settings) <- all if rows.isEmpty || rows.contains(name) do
    RateRow.print(vehicles, name, settings, count, steps)(using RateRow.scenarios)

private[environment] object RateRow:
  private val system =
    ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]

  lazy val scenarios: Scenarios =
    try Scenarios(Scenarios.ours.kinds :+ ScenarioKind(skein.lanes.Tower()))
    catch case _: NoClassDefFoundError => Scenarios.ours

  def print(vehicles: Int, name: String, settings: EnvironmentSettings, count: Int, steps: Int)(using
      Scenarios
  ): Unit =
    val agents  = if settings.learners == "both" then 2 else 1
    val block   = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(agents, count)).order(ByteOrder.nativeOrder)
    val batch   = EnvironmentBatch.of(settings, count, Autoreset.SameStep, block).fold(sys.error(_), identity)
    val buffers = EnvironmentBuffers(block, agents, count)
    def restart(): Unit = batch.reset(Array.tabulate(count)(_ + 7L))
    restart()
    var digest = 0
    for step <- 0 until 300 do
      for agent <- 0 until agents; number <- 0 until count do
        buffers.actions.put(agent * count + number, StrictMath.sin(step * 0.3 + number + agent).toFloat): Unit
      batch.step()
      for i <- 0 until agents * count do
        digest = MurmurHash3.mix(digest, java.lang.Float.floatToIntBits(buffers.rewards.get(i) + 0f))
      for i <- 0 until count do
        digest = MurmurHash3.mix(digest, buffers.terminations.get(i) * 2 + buffers.truncations.get(i))
    val rates = Vector.fill(7):
      restart()
      val before = system.getProcessCpuTime
      for _ <- 0 until steps do batch.step()
      count.toDouble * steps * 1e3 / (system.getProcessCpuTime - before)
    println(
      f"$name%-12s best ${rates.max}%8.3f M steps/s, per vehicle ${rates.max * vehicles}%8.3f, median ${rates.sorted.apply(3)}%8.3f; digest $digest%08x; ${batch.engine}"
    )
    batch.close()
