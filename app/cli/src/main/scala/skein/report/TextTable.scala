package skein.report

/** A table in monospaced text.
  *
  * @param header the columns' names; those that begin with `<` are aligned left
  * @param rows each as wide as the header
  * @param grouped how many leading columns are left out in text where a row repeats all of them
  */
final case class TextTable(header: Vector[String], rows: Vector[Vector[String]], grouped: Int = 0):

  /** The rows as text shows them: without leading cells that a row repeats. */
  def shown: Vector[Vector[String]] =
    rows.headOption.toVector ++ rows.zip(rows.drop(1)).map: (above, row) =>
      if grouped > 0 && row.take(grouped) == above.take(grouped) then
        Vector.fill(grouped)("") ++ row.drop(grouped)
      else row

  def render: String =
    val names                               = header.map(_.stripPrefix("<"))
    val rows                                = shown.map(_.map(TextTable.printable))
    val widths                              = (names +: rows).transpose.map(_.map(_.length).max)
    def line(cells: Vector[String]): String =
      cells.indices
        .map: column =>
          val filler = " " * (widths(column) - cells(column).length)
          if header(column).startsWith("<") then cells(column) + filler else filler + cells(column)
        .mkString("  ")
        .stripTrailing
    (Vector(line(names), widths.map("─" * _).mkString("  ")) ++ rows.map(line)).mkString("\n")

object TextTable:
  /** A column's name, and its cell for an item. */
  type Column[A] = (String, A => String)

  /** A table with a row for each item, whose cells the columns make. */
  def of[A](items: Iterable[A])(columns: Column[A]*): TextTable =
    TextTable(columns.map(_._1).toVector, items.map(item => columns.map(_._2(item)).toVector).toVector)

  /** Replaces control characters by `�`: names are from files and other machines, and could move a terminal's
    * cursor or colour it.
    */
  def printable(text: String): String = text.map: letter =>
    if letter.isControl && letter != '\n' && letter != '\t' then '\ufffd' else letter
