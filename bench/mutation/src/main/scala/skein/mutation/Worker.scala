package skein.mutation

import dotty.tools.dotc.reporting.StoreReporter
import java.io.{BufferedReader, File, InputStreamReader, PrintStream}
import java.net.URLClassLoader
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeoutException
import org.junit.runner.Request
import org.junit.runner.notification.{Failure, RunListener, RunNotifier, StoppedByUserException}
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** Compiles one changed file after the other, and runs suites upon it. A process of its own, because a mutant may never
  * end. Reads from its standard input a line of the file with the changed source, or `-` for none, and the suites, with
  * blanks between; answers each by a line: `invalid`, `killed` and by which suite, `late` where a test ran into its own
  * time limit, or `survived`.
  *
  * The first question is for no change. From it on it knows which classes each suite loads and how long it takes, and
  * runs only those upon a change that load a class of the changed file, the quickest first.
  */
object Worker:

  /** The folders of the project's own classes, in the order of the class path. */
  private val folders =
    System.getProperty("mutation.folders").split(File.pathSeparator).toVector.map(Path.of(_))

  private val answers = System.out

  private val known = mutable.Map.empty[String, Known]

  /** @param classes
    *   of the project's own, that a suite loads
    */
  private final case class Known(classes: Set[String], tookNanos: Long)

  def main(arguments: Array[String]): Unit =
    System.setOut(PrintStream(java.io.OutputStream.nullOutputStream))
    System.setErr(PrintStream(java.io.OutputStream.nullOutputStream))
    val questions = BufferedReader(InputStreamReader(System.in))
    Iterator
      .continually(questions.readLine())
      .takeWhile(_ != null)
      .foreach: line =>
        val file +: suites = line.split(' ').toVector: @unchecked
        answers.println(judge(Option.when(file != "-")(Path.of(file)), suites))
        answers.flush()
    sys.exit(0)

  private def judge(source: Option[Path], suites: Vector[String]): String = source match
    case None       => told(suites, passesAlone)
    case Some(file) =>
      val overlay = Files.createTempDirectory("mutant")
      try
        error(file, overlay).map(text => s"invalid $text").getOrElse:
          val changed = classesIn(overlay)
          val able    = suites
            .filter(suite => known.get(suite).forall(_.classes.exists(changed)))
            .sortBy(known.get(_).fold(0L)(_.tookNanos))
          Using.resource(Loader(overlay +: folders))(loader => told(able, passes(_, loader)))
      finally
        Using.resource(Files.walk(overlay))(
          _.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_))
        )

  private def told(suites: Vector[String], passes: String => Passed): String =
    suites.iterator
      .map(suite => (suite, passes(suite)))
      .collectFirst:
        case (suite, Passed.No) => s"killed $suite"
        case (_, Passed.Late)   => "late"
      .getOrElse("survived")

  /** A test that takes longer than it may says nothing of what it tests where the machine is busy. */
  private enum Passed:
    case Yes, No, Late

  /** Another suite's classes are not loaded for this one. */
  private def passesAlone(suite: String): Passed =
    Using.resource(Loader(folders)): loader =>
      val from   = System.nanoTime()
      val passed = passes(suite, loader)
      known(suite) = Known(loader.loaded, System.nanoTime() - from)
      passed

  private final class Loader(folders: Vector[Path])
      extends URLClassLoader(folders.map(_.toUri.toURL).toArray, Worker.getClass.getClassLoader):
    private val found = java.util.concurrent.ConcurrentHashMap.newKeySet[String]()

    override def findClass(name: String): Class[?] =
      val loaded = super.findClass(name)
      val _      = found.add(name)
      loaded

    def loaded: Set[String] = found.asScala.toSet

  private def classesIn(folder: Path): Set[String] = Using.resource(Files.walk(folder)):
    _.iterator.asScala
      .filter(_.toString.endsWith(".class"))
      .map(folder.relativize(_).toString.stripSuffix(".class").replace('/', '.'))
      .toSet

  /** Why it does not compile, in a line. */
  private def error(source: Path, overlay: Path): Option[String] =
    val classes =
      folders.mkString(File.pathSeparator) + File.pathSeparator + System.getProperty("java.class.path")
    val arguments = Array("-classpath", classes, "-d", overlay.toString, "-nowarn", source.toString)
    dotty.tools.dotc.Main.process(
      arguments,
      StoreReporter(null)
    ).allErrors.headOption.map(_.message.replace('\n', ' '))

  /** Up to the first test that fails. */
  private def passes(suite: String, loader: ClassLoader): Passed =
    Thread.currentThread.setContextClassLoader(loader)
    val notifier = RunNotifier()
    var passed   = Passed.Yes
    notifier.addListener(new RunListener:
      override def testFailure(failure: Failure): Unit =
        passed = if failure.getException.isInstanceOf[TimeoutException] then Passed.Late else Passed.No
        notifier.pleaseStop())
    try Request.aClass(loader.loadClass(suite)).getRunner.run(notifier)
    catch case _: StoppedByUserException => ()
    passed
