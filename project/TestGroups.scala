import sbt.*
import sbt.Keys.*
import sbt.plugins.JvmPlugin

/** Which suites share a JVM, and what runs beside it. */
object TestGroups extends AutoPlugin {

  override def requires: Plugins      = JvmPlugin
  override def trigger: PluginTrigger = allRequirements

  /** Of suites that hold what they measure on the clock to a bound: nothing else runs meanwhile. */
  val Timing: Tags.Tag = Tags.Tag("timing")

  private val timing = Set(
    "skein.link.LinkFidelityLiveSuite",
    "skein.link.PreciseSchedulerLiveSuite",
    "skein.flight.TwinLiveSuite"
  )

  /** These tell the compilers of their JVM to give way, for good, as is done before a live flight: on a busy machine
    * everything behind them would be interpreted. Each has a JVM of its own.
    */
  private val alone = Set(
    "skein.cli.DocumentedCommandsLiveSuite",
    "skein.flight.WarmUpSimulation",
    "skein.loop.planning.BackgroundThreadLiveSuite"
  )

  override val projectSettings: Seq[Setting[?]] = Seq(
    Test / testGrouping := {
      val fork   = Tests.SubProcess((Test / forkOptions).value)
      val groups = (Test / definedTests).value.groupBy { suite =>
        if (timing(suite.name)) "timing" else if (alone(suite.name)) suite.name else "others"
      }
      groups.toSeq.sortBy(_._1).map { case (name, suites) =>
        new Tests.Group(name, suites, fork, if (name == "timing") Seq(Timing -> 1) else Seq.empty)
      }
    }
  )
}
