package skein.mutation

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** What is changed, and by which tests it should be noticed. */
private object Modules:

  val all: Vector[Module] = Vector(
    Module("signal", "core/core/src/main/scala/skein/signal", Vector("skein.signal.*")),
    Module("flow", "stream/flow/src/main/scala/skein/flow", Vector("skein.flow.*")),
    Module(
      "loop",
      "fly/flight/src/main/scala/skein/loop",
      Vector(
        "skein.loop.*Suite",
        "skein.loop.planning.*",
        "skein.loop.*Simulation",
        "skein.loop.RunningGraphLiveSuite",
        "skein.loop.planning.PlanWorkersLiveSuite",
        "skein.loop.learning.LessonsBesideLiveSuite",
        "skein.flight.FailureTellingSimulation",
        "skein.flight.LearningFlightSimulation",
        "skein.flight.OutsidePolicySimulation",
        "skein.flight.ReplaySimulation"
      )
    ),
    Module(
      "record",
      "record/record/src/main/scala/skein/record",
      Vector("skein.record.*", "skein.record.DuckDbRecorderLiveSuite")
    ),
    Module("report", "app/cli/src/main/scala/skein/report", Vector("skein.report.*")),
    Module("measure", "fly/flight/src/main/scala/skein/measure", Vector("skein.measure.*", "skein.report.*")),
    Module(
      "scenario",
      "core/core/src/main/scala/skein/scenario",
      Vector("skein.scenario.*", "skein.measure.*", "skein.report.*")
    ),
    Module(
      "torture",
      "fly/flight/src/main/scala/skein/torture",
      Vector("skein.torture.*Suite", "skein.torture.ChecksSimulation", "skein.torture.RestartSimulation")
    )
  )

  /** Without those that nobody can notice. */
  def mutants(root: Path, module: Module): Vector[Mutant] =
    val files = Using.resource(Files.walk(root.resolve(module.sources)))(
      _.iterator.asScala.filter(_.toString.endsWith(".scala")).toVector.sorted
    )
    for
      file <- files
      source  = Files.readString(file)
      mutants = Mutant.of(module.name, file, source)
      known   = Equivalent.all.filter(_.file == file.getFileName.toString)
      _       = known.find(one => !mutants.exists(one.covers(_, source))).foreach(one =>
        sys.error(s"nothing is any longer what is known to be equivalent: $one")
      )
      mutant <- mutants if !known.exists(_.covers(mutant, source))
    yield mutant

  /** The classes that a pattern such as `skein.flow.*` names: suites and laws, without those that need
    * sockets or the real clock unless they are named.
    */
  def suites(folders: Vector[String], pattern: String): Vector[String] =
    val prefix = pattern.takeWhile(_ != '*')
    val ending = pattern.drop(prefix.length + 1)
    for
      folder <- folders.map(Path.of(_)) if folder.toString.contains("test-classes")
      file   <- classesIn(folder.resolve(prefix.take(prefix.lastIndexOf('.')).replace('.', '/')))
      name = folder.relativize(file).toString.stripSuffix(".class").replace('/', '.')
      if name.startsWith(prefix) && name.endsWith(ending) && (pattern.contains('*') || name == pattern)
      if Ending.exists(name.endsWith) && (name == pattern || !name.endsWith("LiveSuite"))
      if ending.nonEmpty || !pattern.contains('*') || !name.endsWith("Simulation")
    yield name

  private val Ending = Vector("Suite", "Laws", "Golden", "Simulation")

  private def classesIn(folder: Path): Vector[Path] =
    if !Files.isDirectory(folder) then Vector.empty
    else
      Using.resource(
        Files.list(folder)
      )(_.iterator.asScala.filter(_.toString.endsWith(".class")).toVector.sorted)
