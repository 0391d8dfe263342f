package skein.report

/** A table in monospaced text.
  *
  * @param header
  *   the columns' names; those that begin with `<` are aligned left
  * @param rows
  *   each as wide as the header
  */
final case class TextTable(header: Vector[String], rows: Vector[Vector[String]]):

  def render: String =
    val names                               = header.map(_.stripPrefix("<"))
    val widths                              = (names +: rows).transpose.map(_.map(_.length).max)
    def line(cells: Vector[String]): String =
      cells.indices
        .map: column =>
          val filler = " " * (widths(column) - cells(column).length)
          if header(column).startsWith("<") then cells(column) + filler else filler + cells(column)
        .mkString("  ")
        .stripTrailing
    (Vector(line(names), widths.map("─" * _).mkString("  ")) ++ rows.map(line)).mkString("\n")
