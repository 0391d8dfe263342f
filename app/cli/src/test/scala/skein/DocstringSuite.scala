package skein

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import skein.docs.Documentation

/** Every public definition of the top level has a docstring. A companion object needs none beside its class.
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

  test("a missing docstring is found, with annotations or not; companions and private definitions need none"):
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

  private val docstring = """(?s)/\*\*(.*?)\*/""".r

  /** The text of each docstring, in one line. */
  private def texts(source: String): Vector[String] =
    docstring
      .findAllMatchIn(source)
      .map(_.group(1).linesIterator.map(_.strip.stripPrefix("*").strip).filter(_.nonEmpty).mkString(" "))
      .toVector

  private def count(word: String, texts: Vector[String]): Int =
    val whole = s"(?i)\\b$word\\b".r
    texts.map(whole.findAllIn(_).size).sum

  private val Short = 40

  /** Words with several meanings here, and the maximum of their number in docstrings. Rewrite a docstring
    * rather than raise a limit; lower it when there are fewer.
    */
  private val mostOf = Vector(
    "the same" -> 3,
    "told"     -> 5,
    "tells?"   -> 12,
    "asked"    -> 8,
    "came"     -> 4,
    "flown"    -> 5,
    "so many"  -> 0,
    "nobody"   -> 0,
    "at once"  -> 0,
    "upon"     -> 0
  )

  private val mostShort = 189

  test(
    "neither short docstrings nor words with several meanings become more frequent"
  ):
    val all   = sources.flatMap(path => texts(Files.readString(path)))
    val short = all.count(_.length <= Short)
    val grown =
      mostOf.map((word, most) => (word, count(word, all), most)).filter((_, now, most) => now > most)
    assert(short <= mostShort, s"$short docstrings of at most $Short characters, expected $mostShort at most")
    assertEquals(grown, Vector.empty, "word, how often docstrings say it, how often they may")

  test("a docstring's text is found over several lines, and only whole words are counted"):
    val found = texts("/** Told\n  * at once. */\nval x = 1 /* told */\n/** Untold. */")
    assertEquals(found, Vector("Told at once.", "Untold."))
    assertEquals((count("told", found), count("at once", found)), (1, 1))
