package skein.docs

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.matching.Regex

/** Holds what is written to what is there: links lead somewhere, and pages that tell what code says tell it truly. */
class DocumentationSuite extends munit.FunSuite:
  private val root = Documentation.root

  test("every link between pages leads to a file, and to a heading where it names one"):
    val broken =
      for
        page   <- pages
        target <- links(Files.readString(page)) if !isElsewhere(target)
        reason <- mistake(page, target)
      yield s"${root.relativize(page)}: $target: $reason"
    assertEquals(broken, Vector.empty)

  for (name, written) <- Documentation.generated do
    test(s"$name says what the code says"):
      val path = root.resolve(name)
      assert(Files.exists(path), s"$name is missing: ${Documentation.hint}")
      assertNoDiff(Files.readString(path), written(), s"$name is not up to date: ${Documentation.hint}")

  private def pages: Vector[Path] =
    val found = Files.walk(root)
    try
      found.iterator.asScala
        .filter(path => path.toString.endsWith(".md"))
        .filterNot(path =>
          root.relativize(path).iterator.asScala.exists(part => ignored(part.toString))
        )
        .toVector
        .sorted
    finally found.close()

  private val ignored = Set("target", ".git", "node_modules", "flights", "venv")

  private val link: Regex = """!?\[[^\]]*\]\(([^)\s]+)\)""".r

  private def links(text: String): Vector[String] =
    val prose = text.replaceAll("(?s)```.*?```", "").replaceAll("`[^`\n]*`", "")
    link.findAllMatchIn(prose).map(_.group(1)).toVector

  private def isElsewhere(target: String) = target.matches("[a-z]+:.*")

  private def mistake(page: Path, target: String): Option[String] =
    val (file, heading) = target.split("#", 2) match
      case Array(file, heading) => (file, Some(heading))
      case _                    => (target, None)
    val path = if file.isEmpty then page else page.resolveSibling(file).normalize
    if !Files.exists(path) then Some("no such file")
    else
      heading.filterNot(name => anchors(path)(name)).map(missing =>
        s"no heading '$missing' in ${root.relativize(path)}"
      )

  private def anchors(page: Path): Set[String] =
    Files
      .readString(page)
      .linesIterator
      .filter(_.startsWith("#"))
      .map(_.dropWhile(_ == '#').trim.toLowerCase(java.util.Locale.ROOT))
      .map(_.replaceAll("[^\\p{L}\\p{N}_ -]", "").replace(' ', '-'))
      .toSet
