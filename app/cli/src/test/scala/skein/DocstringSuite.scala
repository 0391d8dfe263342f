package skein

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import skein.docs.Documentation

/** Every public definition of the top level says what it is. A companion object may leave that to its class.
  */
class DocstringSuite extends munit.FunSuite:
  private val definition =
    ("""(?:(?:final|sealed|non-sealed|abstract|case|open|opaque|inline|transparent|lazy|public) )*""" +
      """(class|object|trait|enum|type|def|val|given|extension|interface|record)\b\s*(\w*).*""").r

  /** Line and text of each definition without a docstring. */
  private def undocumented(source: String): Vector[String] =
    val lines   = source.linesIterator.toVector
    val defined = lines.zipWithIndex.collect { case (line @ definition(kind, name), at) =>
      (kind, name, at, line)
    }
    val classes = defined.collect { case (kind, name, _, _) if kind != "object" => name }.toSet
    for
      (kind, name, at, line) <- defined
      before = lines.take(at).reverseIterator.find(one => one.nonEmpty && !one.startsWith("@"))
      if !before.exists(_.endsWith("*/")) && !(kind == "object" && classes(name))
    yield s"${at + 1}: $line"

  private val sources: Vector[Path] =
    val rooms   = Files.list(Documentation.root).iterator.asScala.filter(Files.isDirectory(_)).toVector
    val modules = rooms
      .flatMap(room => room +: Files.list(room).iterator.asScala.toVector)
      .map(_.resolve("src/main"))
      .filter(Files.isDirectory(_))
    modules
      .flatMap(Files.walk(_).iterator.asScala)
      .filter(path => path.toString.endsWith(".scala") || path.toString.endsWith(".java"))

  test("every public definition of the top level has a docstring"):
    assert(sources.sizeIs > 500, s"found ${sources.size} sources")
    val missing =
      for
        path <- sources
        one  <- undocumented(Files.readString(path))
      yield s"${Documentation.root.relativize(path)}:$one"
    assertEquals(missing.sorted, Vector.empty)

  test("one that is missing is found, annotated or not; a companion and what is private need none"):
    val source =
      """/** Has one. */
        |final class Told
        |object Told
        |
        |final case class Untold(x: Int)
        |private object Inner
        |@main
        |def start(): Unit =
        |  val local = 1
        |""".stripMargin
    assertEquals(undocumented(source), Vector("5: final case class Untold(x: Int)", "8: def start(): Unit ="))
