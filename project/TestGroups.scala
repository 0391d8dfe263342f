import sbt.*
import sbt.Keys.*
import sbt.plugins.JvmPlugin

/** Which suites share a JVM, how that compiles, and what runs beside it. */
object TestGroups extends AutoPlugin {

  override def requires: Plugins      = JvmPlugin
  override def trigger: PluginTrigger = allRequirements

  object autoImport {
    val testsCompute = settingKey[Boolean]("whether all tests compute for so long that optimising them pays")
  }
  import autoImport.*

  /** Of suites that measure time, or fly for minutes by the clock beside other programs: nothing else runs meanwhile. */
  private val Timing: Tags.Tag = Tags.Tag("timing")

  /** Of suites that mostly wait: for other programs, for the real clock. */
  private val Waiting: Tags.Tag = Tags.Tag("waiting")

  /** One task for each core, and two that wait beside them; what measures time has the machine to itself. */
  val restrictions: Seq[Tags.Rule] = Seq(
    Tags.customLimit { running =>
      def count(tag: Tags.Tag) = running.getOrElse(tag, 0)
      val waiting              = count(Waiting)
      waiting <= 2 && count(Tags.All) - waiting <= 2
    },
    Tags.exclusive(Timing)
  )

  private val timing = Set(
    "skein.cli.ViewLiveSuite",
    "skein.link.LinkFidelityLiveSuite",
    "skein.link.PreciseSchedulerLiveSuite",
    "skein.flight.TwinLiveSuite"
  )

  private val waiting = Set(
    "skein.flight.MavlinkFlightLiveSuite",
    "skein.flight.RunningSimulatorLiveSuite",
    "skein.mcap.OfficialPythonLibraryLiveSuite",
    "skein.mujoco.MujocoOracleLiveSuite",
    "skein.mujoco.MujocoRotorcraftLiveSuite",
    "skein.simulator.BetaflightLiveSuite",
    "skein.simulator.HilServerLiveSuite",
    "skein.simulator.MavsdkLiveSuite",
    "skein.simulator.OfficialPythonClientLiveSuite"
  )

  /** Each has a JVM of its own: the long ones, which then run beside one another, and those that tell the compilers of
    * their JVM to give way, for good, as is done before a live flight: on a busy machine everything behind them would be
    * interpreted.
    */
  private val alone = Map(
    "skein.cli.DocumentedClustersLiveSuite"         -> Jvm.oneCollector,
    "skein.cli.DocumentedCommandsLiveSuite"         -> Jvm.oneCollector,
    "skein.cli.DocumentedFlightsLiveSuite"          -> Jvm.brief,
    "skein.flight.WarmUpSimulation"                 -> Jvm.brief,
    "skein.loop.planning.BackgroundThreadLiveSuite" -> Jvm.oneCollector
  )

  /** By vectors, which are slow until they are optimised, or for long. */
  private val computing = Set(
    "skein.budget.BudgetSuite",
    "skein.budget.ClusterSubjectSuite",
    "skein.budget.ScenarioSubjectSuite",
    "skein.cli.ClusterCommandsLiveSuite",
    "skein.cli.LearnCommandSuite",
    "skein.cli.OwnFamilySuite",
    "skein.cli.SearchCommandSuite",
    "skein.cli.ShippedProgramLiveSuite",
    "skein.cli.TortureQuestionSuite",
    "skein.flight.ConvoySimulation",
    "skein.flight.FailureTellingSimulation",
    "skein.flight.FilmedFlightSimulation",
    "skein.flight.HeldFlightSimulation",
    "skein.flight.KeptLimitsSimulation",
    "skein.flight.LearningFlightSimulation",
    "skein.flight.ReplaySimulation",
    "skein.flight.TeamSimulation",
    "skein.loop.PlanLoopSimulation",
    "skein.loop.ReplaySuite",
    "skein.loop.SensorSimulation",
    "skein.loop.planning.PlanSuite",
    "skein.loop.planning.PlanWorkersLiveSuite",
    "skein.recognition.AprilTagsSuite",
    "skein.recognition.VehicleDetectorSuite",
    "skein.search.LandscapeSuite",
    "skein.search.SearchBlockLaws",
    "skein.search.SearchFileSuite",
    "skein.search.TeamSearchSuite"
  )

  override val projectSettings: Seq[Setting[?]] = Seq(
    testsCompute := false,
    Test / testGrouping := {
      val options  = (Test / forkOptions).value
      val computes = testsCompute.value
      def jvm(more: Seq[String]) =
        Tests.SubProcess(options.withRunJVMOptions(options.runJVMOptions ++ more))
      val groups = (Test / definedTests).value.groupBy { suite =>
        if (timing(suite.name)) "timing"
        else if (waiting(suite.name)) "waiting"
        else if (alone.contains(suite.name)) suite.name
        else if (computes || computing(suite.name)) "computing"
        else "others"
      }
      groups.toSeq.sortBy(_._1).map {
        case ("timing", suites)    => new Tests.Group("timing", suites, jvm(Nil), Seq(Timing -> 1))
        case ("waiting", suites)   => new Tests.Group("waiting", suites, jvm(Jvm.brief), Seq(Waiting -> 1))
        case ("others", suites)    => new Tests.Group("others", suites, jvm(Jvm.brief), Nil)
        case ("computing", suites) => new Tests.Group("computing", suites, jvm(Jvm.oneCollector), Nil)
        case (name, suites)        => new Tests.Group(name, suites, jvm(alone(name)), Nil)
      }
    }
  )
}
