package skein.report

import scalatags.Text.TypedTag
import scalatags.Text.all.*
import scalatags.Text.tags2.{section, title as pageTitle}
import skein.figures.Figure
import skein.measure.{FlightSet, FlightSummary}
import skein.plot.Svg
import skein.units.Decimals
import skein.units.Decimals.brief

/** The report as one self-contained page: no script, no font, no external link. */
object HtmlReport:

  /** @param sections the report's sections, by [[ReportSections.of]] */
  def render(set: FlightSet, sections: Seq[Section]): String = page(
    heading(set),
    p(cls := "lead", abstractOf(set)),
    remarks(set),
    sections.map(part),
    section(h2("Run parameters"), table(parameters(set)))
  )

  private def heading(set: FlightSet): String =
    set.flights.map(_.flight.scenario).distinct match
      case Vector(scenario) => s"Skein: ${Decimals.counted(set.flights.size, "flight")}, scenario $scenario"
      case _                => s"Skein: ${Decimals.counted(set.flights.size, "flight")}"

  private def abstractOf(set: FlightSet): String =
    def named(values: FlightSummary => String) = set.flights.map(values).distinct.mkString(", ")
    s"Loops ${named(_.flight.loop)}; links ${named(_.flight.link)}; one decision per vehicle every " +
      s"${named(_.flight.period.toMillis.brief)} ms; simulator ${named(_.simulator)}; " +
      s"${named(_.flight.clock)} clock."

  /** A page on the spread of many flights of each loop over each link. */
  def spread(flights: Int, sections: Seq[Section]): String =
    page(s"Skein: spread over $flights flights", sections.map(part))

  private def page(title: String, parts: Frag*): String =
    val whole = html(
      lang := "en",
      head(
        meta(charset := "utf-8"),
        meta(name    := "viewport", content := "width=device-width, initial-scale=1"),
        pageTitle(title),
        tag("style")(raw(style))
      ),
      body(h1(title), parts)
    )
    s"<!doctype html>\n${whole.render}\n"

  private def part(shown: Section): TypedTag[String] = section(
    h2(shown.title),
    shown.table.map(table),
    Option.when(shown.note.nonEmpty)(p(cls := "note", shown.note)),
    shown.failure.map(reason => p(cls := "note", strong(reason))),
    shown.figures.map(pictureOf)
  )

  private def pictureOf(shown: Figure): TypedTag[String] =
    figure(Svg.element(shown.drawing, shown.title), figcaption(shown.caption))

  private def table(text: TextTable): TypedTag[String] =
    val left              = text.header.map(_.startsWith("<"))
    def side(column: Int) = Option.when(left(column))(cls := "left")
    div(
      cls := "wide",
      tag("table")(
        thead(tr(text.header.zipWithIndex.map((name, column) => th(side(column), name.stripPrefix("<"))))),
        tbody(text.shown.map(row => tr(row.zipWithIndex.map((cell, column) => td(side(column), cell)))))
      )
    )

  private def remarks(set: FlightSet): Seq[TypedTag[String]] =
    (SummaryTables.remarks(set) ++ TimingVerdict.sentence(set)).map(line => p(cls := "note", strong(line)))

  private def parameters(set: FlightSet): TextTable =
    TextTable.of((set.flights ++ set.twins.flatMap(_.virtual)).distinctBy(_.flight))(
      "<flight"        -> (_.flight.id),
      "<loop"          -> (_.flight.loop),
      "<link"          -> (_.flight.link),
      "seed"           -> (_.flight.seed.toString),
      "period ms"      -> (_.flight.period.toMillis.brief),
      "duration s"     -> (_.flight.duration.toSeconds.brief),
      "<clock"         -> (_.flight.clock),
      "<simulator"     -> (_.simulator),
      "<scenario"      -> (_.flight.scenario),
      "<version"       -> (_.flight.version),
      "<started (UTC)" -> (flown =>
        java.time.Instant.ofEpochSecond(flown.flight.startedAt.toNanos / 1_000_000_000L).toString
      )
    )

  private val style =
    """:root { color-scheme: light }
      |body { font: 15px/1.5 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; color: #1a1a1a;
      |  background: #fff; max-width: 1180px; margin: 2.5rem auto; padding: 0 1.5rem }
      |h1 { font-size: 1.7rem; margin: 0 0 .4rem } h2 { font-size: 1.15rem; margin: 2.4rem 0 .8rem }
      |.lead { color: #444; margin: 0 }
      |.note, figcaption { color: #555; font-size: .85rem; max-width: 52rem; margin: .6rem 0 }
      |figure { margin: 0 } figure svg { max-width: 100%; height: auto; display: block }
      |.wide { overflow-x: auto }
      |table { border-collapse: collapse; font-size: .8rem; font-variant-numeric: tabular-nums }
      |th, td { padding: .28rem .6rem; text-align: right; white-space: nowrap }
      |th { font-weight: 600; border-bottom: 1.5px solid #333; vertical-align: bottom }
      |td { border-bottom: 1px solid #e6e6e6 } .left { text-align: left }
      |th:first-child, td:first-child { padding-left: 0 }
      |@media print { body { margin: 0; max-width: none; padding: 0; font-size: 10pt } table { font-size: 7pt }
      |  th, td { padding: .15rem .3rem } figure, tr { break-inside: avoid } h2 { break-after: avoid } .wide { overflow: visible }
      |  @page { size: A4 landscape; margin: 12mm } }
      |""".stripMargin
