package skein.mutation

import dotty.tools.dotc.reporting.StoreReporter
import java.io.{BufferedReader, File, InputStreamReader, PrintStream}
import java.net.URLClassLoader
import java.nio.file.{Files, Path}
import org.junit.runner.{JUnitCore, Request}
import scala.util.Using

/** Compiles one changed file after the other, and runs suites upon it. A process of its own, because a mutant may never
  * end. Reads from its standard input a line of the file with the changed source, or `-` for none, and the suites, with
  * blanks between; answers each by a line: `invalid`, `killed` and by which suite, or `survived`.
  */
object Worker:

  /** The folders of the project's own classes, in the order of the class path. */
  private val folders =
    System.getProperty("mutation.folders").split(File.pathSeparator).toVector.map(Path.of(_))

  private val answers = System.out

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

  private def judge(source: Option[Path], suites: Vector[String]): String =
    val overlay = Files.createTempDirectory("mutant")
    try
      source.flatMap(error(_, overlay)).map(text => s"invalid $text").getOrElse:
        val urls = (overlay +: folders).map(_.toUri.toURL).toArray
        Using.resource(URLClassLoader(urls, getClass.getClassLoader)): loader =>
          Thread.currentThread.setContextClassLoader(loader)
          suites.find(!passes(_, loader)).fold("survived")(suite => s"killed $suite")
    finally
      Using.resource(Files.walk(overlay))(
        _.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_))
      )

  /** Why it does not compile, in a line. */
  private def error(source: Path, overlay: Path): Option[String] =
    val classes   = folders.mkString(File.pathSeparator) + File.pathSeparator + System.getProperty("java.class.path")
    val arguments = Array("-classpath", classes, "-d", overlay.toString, "-nowarn", source.toString)
    dotty.tools.dotc.Main.process(arguments, StoreReporter(null)).allErrors.headOption.map(_.message.replace('\n', ' '))

  private def passes(suite: String, loader: ClassLoader): Boolean =
    val result = JUnitCore().run(Request.aClass(loader.loadClass(suite)))
    result.wasSuccessful
