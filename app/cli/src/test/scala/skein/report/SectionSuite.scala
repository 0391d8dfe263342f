package skein.report

import skein.figures.Figure
import skein.plot.Drawing
import skein.scenario.Scenarios

class SectionSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  private val table = TextTable(
    Vector("<loop", "<at", "m", "share", "range"),
    Vector(Vector("stream", "12", "8.50", "+2.0", "1 … 2"), Vector("paused", "", "7.5E-4", "-0.5", ""))
  )

  test("data: numbers are numbers, empty cells are null, names are text"):
    val read = ujson.read(Section.json(Seq(Section("One", "note", Some(table)), Section("a picture"))))
    assertEquals(
      read,
      ujson.Obj(
        "tables" -> ujson.Arr(
          ujson.Obj(
            "title"   -> "One",
            "note"    -> "note",
            "columns" -> ujson.Arr("loop", "at", "m", "share", "range"),
            "rows"    -> ujson.Arr(
              ujson.Arr("stream", "12", 8.5, 2.0, "1 … 2"),
              ujson.Arr("paused", ujson.Null, 7.5e-4, -0.5, ujson.Null)
            )
          )
        )
      )
    )

  test("data are in ASCII, whatever the terminal can show"):
    val text = Section.json(Seq(Section("1 ± 2 °", "…", Some(table))))
    assert(clue(text).forall(_ < 128))
    assertEquals(ujson.read(text)("tables")(0)("title").str, "1 ± 2 °")

  test("text: a note is below its table, in lines of at most 100 characters"):
    val note  = Vector.fill(60)("words").mkString(" ")
    val lines = Section.text(Seq(
      Section("One", note, Some(table)),
      Section("Two", table = Some(table))
    )).linesIterator.toVector
    assertEquals(lines.head, "One")
    val told = lines.drop(5).takeWhile(_.nonEmpty)
    assertEquals(told.mkString(" "), note)
    // 16 words of five letters with their blanks are 95.
    assertEquals(told.map(_.length), Vector(95, 95, 95, 71))
    assertEquals(lines.dropWhile(_ != "Two").size, 5)
    def folded(first: Int, second: Int) =
      Section.text(Seq(Section("One", s"${"a" * first} ${"b" * second}", Some(table)))).linesIterator.size - 5
    assertEquals((folded(50, 49), folded(50, 50)), (1, 2))

  test("sections without rows and pictures are left out"):
    val empty   = Section("no rows", table = Some(table.copy(rows = Vector.empty)))
    val rows    = Section("rows", table = Some(table))
    val picture = Section("picture", figures = Vector(Figure("a", "b", "c", Drawing(1, 1, Vector.empty))))
    assertEquals(
      ReportSections.shown(Vector(Section("a title"), rows, empty, picture)),
      Vector(rows, picture)
    )

  test("text, page and data have the same tables in the same order"):
    val set = Report.of(
      Seq("paused" -> "none", "stream" -> "vpn").map((loop, link) =>
        SyntheticFlight(loop, link, seed = 1, seconds = 12)
      )
    )
    val titles = ReportSections.of(set).map(_.title)
    assert(titles.size >= 4, titles.toString)
    val text = ReportSections.text(set)
    val page = HtmlReport.render(set, ReportSections.of(set, ReportFigures.of(set)))
    val data = ujson.read(Section.json(ReportSections.of(set)))("tables").arr.map(_("title").str).toVector
    assertEquals(data, titles)
    for medium <- Seq(text, page.replace("&#39;", "'")) do
      val places = titles.map(medium.indexOf(_))
      assert(places.forall(_ >= 0), s"$titles at $places")
      assertEquals(places, places.sorted)
