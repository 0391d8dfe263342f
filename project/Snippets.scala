import sbt.*

/** Turns the Scala code of documentation pages into sources, so that everything a page shows compiles.
  *
  * Each block is an object of its own, with access to the definitions and imports of the page's earlier
  * blocks. A block's assumptions are in a comment before it, which readers of the page do not see:
  *
  * {{{
  * <!-- scala
  * abstract class Flown(vehicle: Multirotor):
  *   …
  * -->
  * }}}
  *
  * The block replaces the dots, at their indentation. What a page quotes from a source file, below
  * `<!-- file PATH -->` or `<!-- lines of PATH -->`, is left out: it is compiled where it stands, and
  * `DocumentationSuite` compares the two.
  */
object Snippets {
  private val Block = """(?s)(?:<!-- scala\n(.*?)\n-->\n+)?```scala\n(.*?)\n```""".r

  private val Quoted = """(?s)<!-- (?:file|lines of) \S+ -->\n+```scala\n.*?\n```""".r

  /** Writes one source for each of `pages` with Scala code. */
  def sources(root: File, pages: Seq[File], to: File): Seq[File] = {
    val written =
      for {
        page <- pages
        text   = Quoted.replaceAllIn(IO.read(page), found => "\n" * found.matched.count(_ == '\n'))
        blocks = Block.findAllMatchIn(text).toVector if blocks.nonEmpty
      } yield {
        val path    = root.toPath.relativize(page.toPath).toString
        val name    = path.stripSuffix(".md").replaceAll("[^A-Za-z]+", "_")
        val objects = blocks.zipWithIndex.map { case (block, number) =>
          val line    = text.substring(0, block.start(2)).count(_ == '\n') + 1
          val earlier = blocks.take(number).zipWithIndex.flatMap { case (before, one) =>
            s"import Block$one.{given, *}" +: before.group(2).linesIterator.filter(_.startsWith("import ")).toSeq
          }
          val body    = earlier ++ placed(Option(block.group(1)), block.group(2).linesIterator.toSeq)
          s"// $path, line $line\nobject Block$number:\n${body.map("  " + _).mkString("\n")}\n"
        }
        val file = to / s"$name.scala"
        IO.write(file, s"package shown.$name\n\n${objects.mkString("\n")}")
        file
      }
    (IO.listFiles(to).toSet -- written).foreach(IO.delete)
    written
  }

  private def placed(around: Option[String], block: Seq[String]): Seq[String] = {
    val lines = around.fold(Seq.empty[String])(_.linesIterator.toSeq)
    lines.indexWhere(_.trim == "…") match {
      case -1 => lines ++ block
      case at => lines.take(at) ++ block.map(" " * lines(at).indexOf('…') + _) ++ lines.drop(at + 1)
    }
  }
}
