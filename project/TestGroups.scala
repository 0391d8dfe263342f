import sbt.*
import sbt.Keys.*
import sbt.plugins.JvmPlugin

/** Which suites share a JVM, how that compiles, and what runs beside it: as `skein.testing.Groups` marks them, or a module. */
object TestGroups extends AutoPlugin {

  override def requires: Plugins      = JvmPlugin
  override def trigger: PluginTrigger = allRequirements

  object autoImport {
    val testsCompute = settingKey[Boolean]("whether all tests compute for so long that optimising them pays")
  }
  import autoImport.*

  private val Timing: Tags.Tag = Tags.Tag("timing")
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

  override val projectSettings: Seq[Setting[?]] = Seq(
    testsCompute := false,
    Test / testGrouping := {
      val options  = (Test / forkOptions).value
      val classes  = (Test / classDirectory).value
      val computes = testsCompute.value
      // A class file names the traits of its class.
      def is(suite: TestDefinition, mark: String) =
        IO.read(classes / s"${suite.name.replace('.', '/')}.class").contains(s"skein/testing/$mark")
      val groups = (Test / definedTests).value.groupBy { suite =>
        val alone = if (is(suite, "Alone")) suite.name else ""
        (alone, Seq("Timing", "Waiting").find(is(suite, _)).getOrElse(""), computes || is(suite, "Optimised"))
      }
      groups.toSeq.sortBy(_._1).reverse.map { case ((alone, kind, isOptimised), suites) =>
        val (more, tags) = kind match {
          case "Timing"         => (Nil, Seq(Timing -> 1))
          case "Waiting"        => (Jvm.brief, Seq(Waiting -> 1))
          case _ if isOptimised => (Jvm.oneCollector, Nil)
          case _                => (Jvm.brief, Nil)
        }
        val jvm = Tests.SubProcess(options.withRunJVMOptions(options.runJVMOptions ++ more))
        new Tests.Group(s"$alone $kind, optimised: $isOptimised", suites, jvm, tags)
      }
    }
  )
}
