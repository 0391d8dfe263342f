package skein.environment

import java.lang.management.ManagementFactory
import java.nio.{ByteBuffer, ByteOrder}
import java.util.function.LongUnaryOperator
import scala.util.hashing.MurmurHash3
import skein.lanes.Tower
import skein.scenario.{ScenarioKind, Scenarios}

/** How fast are environments, and what are their results? Steps a second of processor time, with a digest of
  * all rewards and ends of 300 steps as a witness. Run: `environment/Test/runMain
  * skein.environment.environmentRates 4096 2000 duel tower`; the words after the numbers choose rows.
  */
@main def environmentRates(count: Int, steps: Int, rows: String*): Unit =
  for name <- RateRow.all.keys if rows.isEmpty || rows.contains(name) do
    val (vehicles, _) = RateRow.all(name)
    val row           = RateRow(name, count)
    val rates         = Vector.fill(7)(count * steps * 1e3 / row.applyAsLong(steps)).sorted
    println(
      f"$name%-12s best ${rates.last}%8.3f M steps/s, per vehicle ${rates.last * vehicles}%8.3f, " +
        f"median ${rates(3)}%8.3f; ${row.witness}"
    )

/** Steps environments of a row repeatedly; returns the processor time, ns. */
private[environment] final class RateRow(name: String, count: Int) extends LongUnaryOperator:
  import RateRow.{all, system}
  private val settings = all(name)._2
  private val agents   = if settings.learners == "both" then 2 else 1
  private val block    =
    ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(
      agents,
      count,
      settings.space
    )).order(ByteOrder.nativeOrder)
  private val batch = EnvironmentBatch
    .of(settings, count, Autoreset.SameStep, block)(using RateRow.scenarios)
    .fold(sys.error(_), identity)
  private val buffers = EnvironmentBuffers(block, agents, count, settings.space)

  private def restart(): Unit = batch.reset(Array.tabulate(count)(_ + 7L))

  val witness: String =
    restart()
    var digest = 0
    for step <- 0 until 300 do
      for row <- 0 until agents * settings.space.outputs; number <- 0 until count do
        buffers.actions.put(
          row * count + number,
          StrictMath.sin(step * 0.3 + number + row).toFloat
        ): Unit
      batch.step()
      for i <- 0 until agents * count do
        digest = MurmurHash3.mix(digest, java.lang.Float.floatToIntBits(buffers.rewards.get(i) + 0f))
      for i <- 0 until count do
        digest = MurmurHash3.mix(digest, buffers.terminations.get(i) * 2 + buffers.truncations.get(i))
    f"digest $digest%08x; ${batch.engine}"

  def applyAsLong(steps: Long): Long =
    restart()
    val before = system.getProcessCpuTime
    for _ <- 0L until steps do batch.step()
    system.getProcessCpuTime - before

private[environment] object RateRow:
  private val system =
    ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]

  lazy val scenarios: Scenarios = Scenarios(Scenarios.ours.kinds :+ ScenarioKind(Tower()))

  /** By name, the vehicles of a world, and the settings. */
  val all: Map[String, (Int, EnvironmentSettings)] =
    val duel     = EnvironmentSettings(startWithinM = (3, 9), episodeS = 20, captureRadiusM = 3)
    val surround = EnvironmentSettings(scenario = "surround", startWithinM = (0, 5))
    val tower    = EnvironmentSettings(scenario = "tower", learners = "keeper", objective = "kept")
    Map(
      "duel"       -> (2, EnvironmentSettings()),
      "noise"      -> (2, EnvironmentSettings(sensors = "position=0.3,velocity=0.1")),
      "dropout"    -> (2, EnvironmentSettings(sensors = "position=0.3,drift=1.5/60s,dropout=5%")),
      "captures"   -> (2, duel),
      "evader"     -> (2, duel.copy(learners = "evader")),
      "both"       -> (2, duel.copy(learners = "both")),
      "predictive" -> (2, duel.copy(loop = "predictive")),
      "paused"     -> (2, duel.copy(loop = "paused", link = "none", learners = "both")),
      "drag"       -> (2, duel.copy(plant = "drag")),
      "quadrotor"  -> (2, duel.copy(plant = "quadrotor")),
      "climbing"   -> (2, duel.copy(climbMps = 3)),
      "level"      -> (2, duel.copy(plant = "tilt")),
      "surround"   -> (6, surround),
      "convoy"     -> (5, EnvironmentSettings(scenario = "convoy", learners = "escort", plant = "drag")),
      "tower"      -> (5, tower)
    )
