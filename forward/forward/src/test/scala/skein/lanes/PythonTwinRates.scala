package skein.lanes

import com.sun.management.OperatingSystemMXBean
import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import skein.forward.*
import skein.optimise.{Objective, ScenarioTerm}
import skein.scenario.*
import skein.simd.WorldRandom

/** Compares the rates of scenarios written in Python with their Scala twins, by the processor's time of
  * alternating rounds: `forward/Test/runMain skein.lanes.PythonTwinRates FOLDER [NAME]`, the folder of their files.
  */
object PythonTwinRates:
  private val Worlds = 16384
  private val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val system = ManagementFactory.getPlatformMXBean(classOf[OperatingSystemMXBean])

  def main(arguments: Array[String]): Unit =
    val twins = Seq("ring" -> Surround(), "pursuit" -> PaperDuel(), "network" -> NetworkDuel.of(Path.of(arguments(0))))
    for (name, twin) <- twins if arguments.drop(1).forall(_ == name); share <- Seq(true, false) do
      val text   = Files.readString(Path.of(arguments(0)).resolve(s"$name.scenario"))
      val python = ScenarioText.read(text).fold(why => throw IllegalArgumentException(why), _.standard)
      val judged = Objective.measures(python).values.toVector.flatMap(ScenarioTerm(_).judged(20, 0.1))
      val batch  = TeamBatch(LoopTiming.Stream(), lag, threads = 1)
      def seconds(of: Scenario): Double =
        val team   = TeamCandidate(Engagement.of(of.fleet, durationS = 20), judged)
        val worlds = new TeamWorlds:
          def size: Int                            = Worlds
          override def shareEpisodes: Boolean      = share
          def key(world: Int): Int                 = WorldRandom.key(3, 1, if share then 0 else world)
          def link(world: Int): Delays             = DelayTable.vpn
          def candidate(world: Int): TeamCandidate = team
        val from = system.getProcessCpuTime
        val sum  = batch.fly(worlds).values(0).sum
        println(s"  $sum")
        (system.getProcessCpuTime - from) * 1e-9
      for _ <- 1 to 3 do Seq(python, twin).foreach(seconds)
      val rounds       = Vector.fill(7)((seconds(python), seconds(twin)))
      val (one, other) = (rounds.map(_._1).min, rounds.map(_._2).min)
      println(
        f"$name, shared $share: python ${Worlds / one}%.0f, scala ${Worlds / other}%.0f episodes a second of one core, ratio ${other / one}%.3f"
      )
