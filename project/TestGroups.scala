import sbt.*
import sbt.Keys.*
import sbt.plugins.JvmPlugin

/** Groups suites: which share a JVM, its compiler options, what runs in parallel, and which ones `test` leaves
  * to `testAll`: by the marks in `skein.testing.Groups`, or by module.
  */
object TestGroups extends AutoPlugin {

  override def requires: Plugins      = JvmPlugin
  override def trigger: PluginTrigger = allRequirements

  object autoImport {
    val testsCompute = settingKey[Boolean]("whether all tests compute for so long that optimising them pays")
    val testsLast    = settingKey[Boolean]("whether its tests run when all others have ended, so that they need two JVMs")
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

  /** Whether a suite has a mark: a class file contains the names of its traits. */
  private def isMarked(classes: File, suite: String, mark: String): Boolean =
    IO.read(classes / s"${suite.replace('.', '/')}.class").contains(s"skein/testing/$mark")

  override val projectSettings: Seq[Setting[?]] = Seq(
    testsCompute := false,
    testsLast    := false,
    Test / test / testOptions += {
      val classes = (Test / classDirectory).value
      Tests.Filter(suite => !isMarked(classes, suite, "Lengthy"))
    },
    Test / testGrouping := {
      val options  = (Test / forkOptions).value
      val classes  = (Test / classDirectory).value
      val computes = testsCompute.value
      val isLast   = testsLast.value
      val suites   = (Test / definedTests).value
      val second   =
        if (isLast) suites.map(_.name).sorted.zipWithIndex.collect { case (name, i) if i % 2 == 1 => name }.toSet
        else Set.empty[String]
      val groups = suites.groupBy { suite =>
        def is(mark: String) = isMarked(classes, suite.name, mark)
        val half             = if (second(suite.name)) "second" else ""
        val alone            = if (is("Lengthy")) suite.name else half
        (alone, Seq("Timing", "Waiting").find(is).getOrElse(""), computes || is("Optimised"))
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
