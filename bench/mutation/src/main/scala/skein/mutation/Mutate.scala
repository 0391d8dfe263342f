package skein.mutation

import java.io.File
import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import java.util.concurrent.{Executors, TimeUnit, TimeoutException}
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future}
import scala.jdk.CollectionConverters.*
import scala.util.{Random, Using}

/** What became of a mutant. */
enum Fate:
  case Survived
  case Killed(by: String)

  /** Twice: that counts as noticed. */
  case TimedOut, ProcessEnded

  /** It does not compile. */
  case Invalid(why: String)

/** Changes one thing at a time in the sources and runs the tests that ought to notice: `bench/mutation` in
  * `docs/testing.md`.
  */
@main def mutate(arguments: String*): Unit =
  def option(name: String) =
    arguments.sliding(2).collectFirst { case Seq(`name`, value) => value }
  val seed    = option("--seed").fold(System.nanoTime())(_.toLong)
  val sample  = option("--sample").fold(Int.MaxValue)(_.toInt)
  val minutes = option("--minutes").fold(24 * 60)(_.toInt)
  val only    = option("--modules").fold(Modules.all.map(_.name))(_.split(',').toVector)
  val lines   =
    option("--only").map(file => Files.readAllLines(Path.of(file)).asScala.map(_.split('\t').last.trim).toSet)
  val root = Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at =>
    Files.exists(at.resolve("build.sbt"))
  ).get
  println(s"seed $seed")
  val until = System.nanoTime() + minutes.toLong * 60_000_000_000L
  val work  =
    if arguments.contains("--named") then Named.all(root)
    else
      for name <- only yield
        val module = Modules.all.find(_.name == name).getOrElse(sys.error(s"no module $name"))
        (module, Modules.mutants(root, module))
  val scores =
    for (module, all) <- work yield
      val chosen  = Random(seed).shuffle(all).filter(mutant => lines.forall(_(mutant.toString)))
      val session = Session(module, quick = arguments.contains("--quick"))
      val judged  =
        try
          session.checkUnchanged()
          chosen.iterator
            .map(mutant => (mutant, session.fate(mutant)))
            .filterNot(_._2.isInstanceOf[Fate.Invalid])
            .takeWhile(_ => System.nanoTime() < until)
            .take(sample)
            .map: (mutant, fate) =>
              println(s"${module.name}\t$fate\t$mutant")
              (mutant, fate)
            .toVector
        finally session.close()
      Score(module.name, all.size, judged)
  scores.foreach(score => println(score.line))

/** @param found
  *   mutants in all, those included that do not compile
  */
final case class Score(module: String, found: Int, judged: Vector[(Mutant, Fate)]):
  def line: String =
    val (numbers, others) = judged.partition(_._1.isNumber)
    s"$module, $found places: ${Score.of(judged)}; numbers ${Score.of(numbers)}; all else ${Score.of(others)}"

object Score:
  /** The share noticed, with Wilson's interval of 95 %. */
  private def of(judged: Vector[(Mutant, Fate)]): String =
    val survived = judged.count(_._2 == Fate.Survived)
    val endless  = judged.count(_._2 == Fate.TimedOut)
    val (n, z)   = (judged.size.max(1).toDouble, 1.96)
    val share    = 1 - survived / n
    val middle   = (share + z * z / (2 * n)) / (1 + z * z / n)
    val half     = z / (1 + z * z / n) * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    def percent(value: Double) = (100 * value).round
    if judged.isEmpty then "none tried"
    else
      s"${percent(share)} % (${percent(middle - half)} … ${percent(middle + half)}) of ${judged.size}, $survived not noticed" +
        (if endless > 0 then s", $endless by not ending" else "")

/** Runs mutants of one module, one after the other, in a [[Worker]] that is started again where one does not
  * end.
  */
private final class Session(module: Module, quick: Boolean):
  private val pool               = Executors.newCachedThreadPool()
  private given ExecutionContext = ExecutionContext.fromExecutor(pool)
  private val changed            = Files.createTempDirectory("mutation")
  private val (jars, own) = System.getProperty("java.class.path").split(File.pathSeparator).toVector.distinct
    .partition(entry => entry.endsWith(".jar") || entry.contains("mutation"))
  private val suites = module.suites
    .flatMap(pattern => Modules.suites(own, pattern))
    .distinct
    .filterNot(quick && _.endsWith("Simulation"))
  private var worker = start()
  private var limit  = 10.minutes

  /** What cannot pass unchanged notices nothing. */
  def checkUnchanged(): Unit =
    if suites.isEmpty then sys.error(s"${module.name}: no suites of ${module.suites.mkString(", ")}")
    unchanged() match
      case Fate.Survived => ()
      case other         => sys.error(s"${module.name}: unchanged sources do not pass: $other")

  /** Sets the time that a mutant has. */
  private def unchanged(): Fate =
    limit = 10.minutes
    val from = System.nanoTime()
    val fate = ask("-")
    val took = (System.nanoTime() - from).nanos
    limit = took * 4 + 60.seconds
    println(s"${module.name}: ${suites.size} suites take ${took.toMillis / 1000.0} s unchanged")
    fate

  /** What does not end is tried again, in a time measured anew: the machine may have been busy. */
  def fate(mutant: Mutant): Fate =
    val file = changed.resolve(mutant.file.getFileName)
    Files.writeString(file, mutant.applied(Files.readString(mutant.file)))
    ask(file.toString) match
      case Fate.TimedOut | Fate.ProcessEnded =>
        unchanged() match
          case Fate.Survived => ask(file.toString)
          case other         =>
            println(s"${module.name}\tnot judged, as unchanged sources do not pass now: $other\t$mutant")
            Fate.Invalid("the machine is too busy")
      case told => told

  def close(): Unit =
    worker.destroyForcibly()
    pool.shutdownNow()
    Using.resource(
      Files.walk(changed)
    )(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))

  private def ask(file: String): Fate =
    val in = worker.outputWriter()
    in.write((file +: suites).mkString("", " ", "\n"))
    in.flush()
    val answer = Future(worker.inputReader().readLine())
    try
      Option(Await.result(answer, limit)) match
        case Some(s"invalid $why")  => Fate.Invalid(why)
        case Some("survived")       => Fate.Survived
        case Some("late")           => stopped()
        case Some(s"killed $suite") => Fate.Killed(suite)
        case Some(other)            => sys.error(s"the worker answered: $other")
        case None                   =>
          worker = start()
          Fate.ProcessEnded
    catch case _: TimeoutException => stopped()

  private def stopped(): Fate =
    worker.destroyForcibly().waitFor(10, TimeUnit.SECONDS)
    worker = start()
    Fate.TimedOut

  private def start(): Process =
    val java    = Path.of(System.getProperty("java.home"), "bin", "java").toString
    val options = ManagementFactory.getRuntimeMXBean.getInputArguments.asScala
      .filterNot(_.startsWith("-Xm"))
    val command = Vector(java) ++ options ++ Vector(
      "-Xmx1200m",
      s"-Dmutation.folders=${own.mkString(File.pathSeparator)}",
      s"-Dmutation.changed=${own.filter(module.compilesTo).mkString(File.pathSeparator)}",
      "-cp",
      jars.mkString(File.pathSeparator),
      "skein.mutation.Worker"
    )
    ProcessBuilder(command.asJava).redirectError(ProcessBuilder.Redirect.DISCARD).start()
