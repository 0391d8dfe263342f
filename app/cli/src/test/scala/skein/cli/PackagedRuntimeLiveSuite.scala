package skein.cli

import java.io.{PrintWriter, StringWriter}
import java.nio.file.{Files, Path}
import java.util.spi.ToolProvider
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.docs.Documentation
import skein.testing.{Lengthy, Unhurried}

/** The packaged program's own Java runtime. Made by `./sbtw cli/program`, or by `./skein`. */
class PackagedRuntimeLiveSuite extends munit.FunSuite, Lengthy, Unhurried:
  private lazy val home: Option[Path] =
    val folder = Documentation.root.resolve("app/cli/target/package")
    Option.when(Files.isDirectory(folder))(folder).flatMap: folder =>
      Using.resource(Files.list(folder)):
        _.iterator.asScala.find(one =>
          one.getFileName.toString.startsWith("skein-") && Files.isDirectory(one)
        )

  /** Modules of code that Skein never calls: Agrona's generator of classes, and logins by Kerberos. */
  private val unused = Set("java.compiler", "java.security.jgss")

  test("it has every module of the JDK that a class in the program's jars, or in its extras, refers to"):
    assume(home.isDefined, "./sbtw cli/program makes it")
    val extras = home.get.resolveSibling("extras").resolve(home.get.getFileName).resolve("lib/extra")
    val jars   = Vector(home.get.resolve("lib"), extras).flatMap: folder =>
      Using.resource(
        Files.list(folder)
      )(_.iterator.asScala.map(_.toString).toVector).filter(_.endsWith(".jar"))
    val java    = home.get.resolve("runtime/bin/java").toString
    val listed  = ProcessBuilder(java, "--list-modules").start()
    val present = String(listed.getInputStream.readAllBytes()).linesIterator.map(_.takeWhile(_ != '@')).toSet
    val needed  = modulesOf(jars)
    assert(needed.contains("java.base"), needed)
    assertEquals(needed -- present -- unused, Set.empty[String])

  private def modulesOf(jars: Vector[String]): Set[String] =
    val out     = StringWriter()
    val printed = PrintWriter(out)
    // jdeps resolves a jar with a module descriptor together with all modules that this requires.
    val plain     = jars.filterNot(jar => jar.contains("progressbar") || jar.contains("jline"))
    val arguments =
      Vector("--ignore-missing-deps", "--multi-release", "25", "-q", "-s", "--class-path", jars.mkString(":"))
    val status = ToolProvider.findFirst("jdeps").get.run(printed, printed, (arguments ++ plain)*)
    printed.flush()
    assertEquals(status, 0, out.toString)
    "-> ((?:java|jdk)[.][\\w.]+)".r.findAllMatchIn(
      out.toString
    ).map(_.group(1)).filterNot(_.endsWith(".jar")).toSet
