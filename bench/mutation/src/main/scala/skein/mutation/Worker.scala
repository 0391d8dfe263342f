package skein.mutation

import dotty.tools.dotc.reporting.StoreReporter
import java.io.{BufferedReader, File, InputStreamReader, PrintStream}
import java.lang.classfile.ClassFile
import java.lang.classfile.constantpool.ClassEntry
import java.net.URLClassLoader
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeoutException
import org.junit.runner.Request
import org.junit.runner.notification.{Failure, RunListener, RunNotifier, StoppedByUserException}
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** Compiles one changed file after the other, and runs suites upon it. A process of its own, because a mutant
  * may never end. Reads from its standard input a line of the file with the changed source, or `-` for none,
  * and the suites, with blanks between; answers each by a line: `invalid`, `killed` and by which suite,
  * `late` where a test ran into its own time limit, or `survived`.
  *
  * The first question is for no change. From it on it knows which classes each suite loads and how long it
  * takes, and runs only those upon a change that load a class of the changed file, the quickest first. What
  * cannot know of the changed file is loaded once for all of them.
  */
object Worker:

  /** The folders of the project's own classes, in the order of the class path. */
  private val folders = paths("mutation.folders")

  private def paths(property: String): Vector[Path] =
    System.getProperty(property).split(File.pathSeparator).toVector.map(Path.of(_))

  private val answers = System.out

  private val known = mutable.Map.empty[String, Known]

  /** @param classes
    *   that a change may reach, and that a suite loads
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
          Using.resource(Loader(overlay +: affected, unaffected))(loader => told(able, passes(_, loader)))
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
    Using.resource(Loader(affected, unaffected)): loader =>
      val from = System.nanoTime()
      // The first time, nothing is compiled yet.
      val passed = passes(suite, loader) match
        case Passed.Late => passes(suite, loader)
        case told        => told
      known(suite) = Known(loader.loaded, System.nanoTime() - from)
      passed

  /** The folders of the classes that are changed, and those that name any class of these. */
  private lazy val affected: Vector[Path] =
    def wider(found: Set[Path]): Set[Path] =
      val all = found ++ folders.filter(uses(_).exists(found))
      if all.size == found.size then all else wider(all)
    folders.filter(wider(paths("mutation.changed").toSet))

  /** What no change reaches stays loaded, and so compiled. */
  private lazy val unaffected = Loader(folders.filterNot(affected.contains), Worker.getClass.getClassLoader)

  private lazy val home: Map[String, Path] =
    folders.flatMap(folder => classesIn(folder).map(_ -> folder)).toMap

  /** By folder, those whose classes its own name. */
  private lazy val uses: Map[Path, Set[Path]] =
    folders.map(folder => folder -> files(folder).flatMap(named).flatMap(home.get).toSet).toMap

  private def named(file: Path): Vector[String] =
    ClassFile.of().parse(file).constantPool.iterator.asScala.collect { case one: ClassEntry =>
      one.asInternalName.replace('/', '.')
    }.toVector

  private final class Loader(folders: Vector[Path], parent: ClassLoader)
      extends URLClassLoader(folders.map(_.toUri.toURL).toArray, parent):
    private val found = java.util.concurrent.ConcurrentHashMap.newKeySet[String]()

    override def findClass(name: String): Class[?] =
      val loaded = super.findClass(name)
      val _      = found.add(name)
      loaded

    def loaded: Set[String] = found.asScala.toSet

  private def classesIn(folder: Path): Set[String] =
    files(folder).map(folder.relativize(_).toString.stripSuffix(".class").replace('/', '.')).toSet

  private def files(folder: Path): Vector[Path] =
    if !Files.isDirectory(folder) then Vector.empty
    else Using.resource(Files.walk(folder))(_.iterator.asScala.filter(_.toString.endsWith(".class")).toVector)

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
