package skein.report

import skein.figures.Figure
import ujson.{Arr, Null, Num, Obj, Str, Value}

/** A part of a report: rendered as text for the terminal, as part of a page, and as data for scripts.
  *
  * @param note how to read it; may be empty
  * @param table None for sections of pictures
  * @param figures the figures, on the page only
  * @param failure why it is empty: the scenario's code threw; on the page only
  */
final case class Section(
    title: String,
    note: String = "",
    table: Option[TextTable] = None,
    figures: Vector[Figure] = Vector.empty,
    failure: Option[String] = None
)

object Section:

  /** All sections with a table, one after the other. */
  def text(sections: Seq[Section]): String =
    TextTable.printable(
      sections.flatMap(section => section.table.map(textOf(section, _))).mkString("\n\n")
    )

  private def textOf(section: Section, table: TextTable): String =
    (Vector(section.title, table.render) ++ Paragraph.lines(section.note, 100)).mkString("\n")

  /** All tables, in ASCII: `{"tables": [{"title", "note", "columns", "rows"}]}`. A row is a list as long as
    * the columns; a cell is a number if it reads as one, null if it is empty, and else text.
    *
    * @param more further fields
    */
  def json(sections: Seq[Section], more: (String, Value)*): String =
    val tables = sections.flatMap(section => section.table.map(jsonOf(section, _)))
    ujson.write(Obj("tables" -> Arr.from(tables), more*), indent = 2, escapeUnicode = true)

  private def jsonOf(section: Section, table: TextTable): Value = Obj(
    "title"   -> section.title,
    "note"    -> section.note,
    "columns" -> Arr.from(table.header.map(name => Str(name.stripPrefix("<")))),
    "rows"    -> Arr.from(table.rows.map(row => Arr.from(row.zip(table.header).map(cell))))
  )

  /** A cell's value; the left columns are names, even if these look like numbers. */
  private def cell(text: String, column: String): Value =
    if text.isEmpty then Null
    else if column.startsWith("<") || !text.matches("[-+]?[0-9]+(\\.[0-9]+)?(E-?[0-9]+)?") then Str(text)
    else Num(text.toDouble)
