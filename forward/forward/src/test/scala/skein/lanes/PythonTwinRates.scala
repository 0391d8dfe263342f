package skein.lanes

import com.sun.management.OperatingSystemMXBean
import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import skein.forward.*
import skein.optimise.{Objective, ScenarioTerm}
import skein.scenario.*
import skein.simd.WorldRandom

/** Compares the rates of scenarios written in Python with their Scala twins, by the processor's time of
  * alternating rounds: `forward/Test/runMain skein.lanes.PythonTwinRates FOLDER [NAME]`, the folder of their
  * files.
  */
object PythonTwinRates:
  private val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val Times  = 24 // the processor's time comes in steps of 10 ms
  private val system = ManagementFactory.getPlatformMXBean(classOf[OperatingSystemMXBean])

  def main(arguments: Array[String]): Unit =
    val folder = Path.of(arguments(0))
    val twins  = Seq("ring" -> Surround(), "pursuit" -> PaperDuel(), "network" -> NetworkPair.of(folder))
    for (name, twin) <- twins if arguments.drop(1).forall(_ == name); share <- Seq(true, false) do
      val text   = Files.readString(folder.resolve(s"$name.scenario"))
      val python = ScenarioText.read(text).fold(why => throw IllegalArgumentException(why), _.standard)
      val judged = Objective.measures(python).values.toVector.flatMap(ScenarioTerm(_).judged(20, 0.1))
      val batch  = TeamBatch(LoopTiming.Stream(), lag, threads = 1)
      def seconds(of: Scenario): Double =
        val team   = TeamCandidate(Engagement.of(of.fleet, durationS = 20), judged)
        val worlds = new TeamWorlds:
          def size: Int                            = 4096
          override def shareEpisodes: Boolean      = share
          def key(world: Int): Int                 = WorldRandom.key(3, 1, if share then 0 else world)
          def link(world: Int): Delays             = DelayTable.vpn
          def candidate(world: Int): TeamCandidate = team
        val from = system.getProcessCpuTime
        val sums = Vector.fill(Times)(batch.fly(worlds).values(0).sum)
        println(s"  ${sums.head}")
        (system.getProcessCpuTime - from) * 1e-9 / Times
      for _ <- 1 to 3 do Seq(python, twin).foreach(seconds)
      val rounds       = Vector.fill(7)((seconds(python), seconds(twin)))
      val (one, other) = (rounds.map(_._1).min, rounds.map(_._2).min)
      println(
        f"$name, shared $share: python ${4096 / one}%.0f, scala ${4096 / other}%.0f episodes a second of one core, ratio ${other / one}%.3f"
      )
