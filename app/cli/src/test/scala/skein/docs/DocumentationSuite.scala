package skein.docs

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.matching.Regex
import skein.cli.OurScenarios

/** Checks the documentation: links resolve, and generated pages are up to date. */
class DocumentationSuite extends munit.FunSuite:
  private val root = Documentation.root

  test("every link between pages leads to an existing file, and to an existing heading"):
    val broken =
      for
        page   <- pages
        target <- links(Files.readString(page)) if !isElsewhere(target)
        reason <- mistake(page, target)
      yield s"${root.relativize(page)}: $target: $reason"
    assertEquals(broken, Vector.empty)

  for (name, written) <- Documentation.generated do
    test(s"$name agrees with the code"):
      val path = root.resolve(name)
      assert(Files.exists(path), s"$name is missing: ${Documentation.hint}")
      assertNoDiff(Files.readString(path), written(), s"$name is not up to date: ${Documentation.hint}")

  test("code on a page is an excerpt of its source file"):
    val shown =
      for
        page  <- pages
        found <- quoted.findAllMatchIn(Files.readString(page))
      yield (root.relativize(page), found.group(1) == "file", found.group(2), found.group(3))
    assert(shown.sizeIs >= 2, shown)
    for (page, isWhole, file, code) <- shown do
      val source = Files.readString(root.resolve(file))
      if isWhole then assertNoDiff(code, source, s"$page shows another $file")
      else assertEquals(strayed(code, source), None, s"$page shows lines that $file does not have there")

  test("a changed or moved line is found"):
    val source = "def a =\n  b\n  c\n  d\n"
    assertEquals(strayed("b\n…\nd", source), None)
    assertEquals(strayed("b\nd", source), Some("b\nd"))
    assertEquals(strayed("d\n…\nb", source), Some("b"))

  test("the README and the configuration name every scenario"):
    val names = OurScenarios.all.kinds.map(_.name)
    for page <- Seq("README.md", "fly/flight/src/main/resources/reference.conf") do
      val text = Files.readString(root.resolve(page))
      assertEquals(names.filterNot(text.contains), Vector.empty, page)

  test("every example has a README with a picture, and is in the list of examples"):
    val list    = Files.readString(root.resolve("examples/README.md"))
    val folders = Files.list(root.resolve("examples")).iterator.asScala.filter(Files.isDirectory(_)).toVector
    assert(folders.sizeIs > 5, folders)
    for folder <- folders.sorted do
      val name = folder.getFileName.toString
      assert(list.contains(s"[$name]($name/README.md)"), name)
      assert(Files.readString(folder.resolve("README.md")).contains("!["), s"$name/README.md has no picture")

  private val quoted: Regex = """(?s)<!-- (file|lines of) (\S+) -->\n+```scala\n(.*?)\n```""".r

  /** The first passage of `code` that `source` does not contain after the previous one. Passages are
    * separated by lines of `…`; indentation is ignored.
    */
  private def strayed(code: String, source: String): Option[String] =
    def lines(text: String) = text.linesIterator.map(_.trim).toVector
    lines(code)
      .foldLeft(Vector(Vector.empty[String])): (passages, line) =>
        if line == "…" then passages :+ Vector.empty else passages.init :+ (passages.last :+ line)
      .filter(_.nonEmpty)
      .foldLeft[Either[Vector[String], Int]](Right(0)): (at, passage) =>
        at.flatMap: from =>
          lines(source).indexOfSlice(passage, from) match
            case -1    => Left(passage)
            case found => Right(found + passage.size)
      .swap.toOption.map(_.mkString("\n"))

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
