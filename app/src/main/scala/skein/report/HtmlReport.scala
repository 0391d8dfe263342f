package skein.report

import scalatags.Text.TypedTag
import scalatags.Text.all.*
import scalatags.Text.tags2.{section, title as pageTitle}
import skein.plot.Svg
import skein.record.Flight

/** The report as one page that needs nothing beside itself: no script, no font, no link to anywhere. */
object HtmlReport:

  def render(set: FlightSet, figures: Seq[Figure]): String =
    val page = html(
      lang := "en",
      head(
        meta(charset := "utf-8"),
        meta(name    := "viewport", content := "width=device-width, initial-scale=1"),
        pageTitle(heading(set)),
        tag("style")(raw(style))
      ),
      body(
        h1(heading(set)),
        p(cls := "lead", abstractOf(set)),
        Option.when(set.duels.flights.nonEmpty)(
          section(h2("Results"), table(SummaryTables.distances(set.duels)), p(cls := "note", resultsNote))
        ),
        set.teams.map(flown =>
          section(
            h2(s"Results: ${flown.scenario}"),
            table(TeamTables.flights(flown)),
            p(cls := "note", TeamTables.note(flown.flights.head.result.scenario))
          )
        ),
        figures.filterNot(figure => withTables(figure.name)).map(figureOf),
        deviations(set.deviations, figures),
        predictions(set.predictions, figures),
        twins(set, figures),
        plans(set),
        section(
          h2("Observations per decision, ms"),
          table(SummaryTables.observations(set)),
          p(cls := "note", observationsNote)
        ),
        section(h2("Drops, skips and timeouts"), table(SummaryTables.counts(set)), aborts(set)),
        section(h2("Run parameters"), table(parameters(set)))
      )
    )
    s"<!doctype html>\n${page.render}\n"

  private def heading(set: FlightSet): String =
    set.flights.map(_.flight.scenario).distinct match
      case Vector(scenario) => s"Skein: ${set.flights.size} flights, scenario $scenario"
      case _                => s"Skein: ${set.flights.size} flights"

  private def abstractOf(set: FlightSet): String =
    def named(values: Flight => String) =
      set.flights.map(summary => values(summary.flight)).distinct.mkString(", ")
    s"Loops ${named(_.loop)}; links ${named(_.link)}; one decision per vehicle every " +
      s"${named(flight => SummaryTables.brief(flight.period.toMillis))} ms; simulator ${named(_.simulator)}; " +
      s"${named(_.clock)} clock."

  private val resultsNote =
    "Horizontal distance between pursuer and evader at equal instants of the simulator's clock; sd is the standard " +
      "deviation over the last 10 s. The paper's values are from its text and published result files; its paused flight " +
      "went over the direct link."

  private val observationsNote =
    "Mean/median/99th percentile in ms, by the role that was decided for. Ages count from the arrival of the reading used, as published; the true " +
      "ages, means, count from when physics was sampled, by the simulator's clock."

  /** What many flights of each loop over each link come to, as a page. */
  def spread(flights: Seq[FlightSummary], tables: Seq[TextTable], figures: Seq[Figure]): String =
    val title = s"Skein: spread over ${flights.size} flights"
    val page  = html(
      lang := "en",
      head(meta(charset := "utf-8"), pageTitle(title), tag("style")(raw(style))),
      body(
        h1(title),
        tables.map(spread => section(table(spread))),
        deviations(Deviation.of(flights), figures),
        predictions(PredictionGroup.of(flights), figures)
      )
    )
    s"<!doctype html>\n${page.render}\n"

  /** Figures that stand beside a table of their own. */
  private val withTables = Set(TwinFigure.name, DeviationFigure.name, PredictionFigure.name)

  private def deviations(deviations: Vector[Deviation], figures: Seq[Figure]): Option[TypedTag[String]] =
    Option.when(deviations.nonEmpty):
      section(
        h2("Deviation from the paused truth"),
        table(Deviation.table(deviations)),
        figures.filter(_.name == DeviationFigure.name).map(pictureOf)
      )

  private def predictions(groups: Vector[PredictionGroup], figures: Seq[Figure]): Option[TypedTag[String]] =
    Option.when(groups.nonEmpty):
      section(
        h2("Prediction error against age"),
        table(PredictionGroup.table(groups)),
        figures.filter(_.name == PredictionFigure.name).map(pictureOf)
      )

  private def figureOf(shown: Figure): TypedTag[String] = section(h2(shown.title), pictureOf(shown))

  private def pictureOf(shown: Figure): TypedTag[String] =
    figure(Svg.element(shown.drawing, shown.title), figcaption(shown.caption))

  private def plans(set: FlightSet): Option[TypedTag[String]] =
    Option.when(set.flights.exists(_.planning.isDefined)):
      section(h2(PlanTable.title), table(PlanTable.of(set)), p(cls := "note", s"${PlanTable.note(set)}."))

  private def twins(set: FlightSet, figures: Seq[Figure]): Option[TypedTag[String]] =
    Option.when(set.twins.nonEmpty):
      section(
        h2("Live against virtual"),
        table(SummaryTables.twins(set)),
        p(cls := "note", SummaryTables.twinsNote.capitalize + "."),
        figures.filter(_.name == TwinFigure.name).map(pictureOf)
      )

  private def table(text: TextTable): TypedTag[String] =
    val left              = text.header.map(_.startsWith("<"))
    def side(column: Int) = Option.when(left(column))(cls := "left")
    div(
      cls := "wide",
      tag("table")(
        thead(tr(text.header.zipWithIndex.map((name, column) => th(side(column), name.stripPrefix("<"))))),
        tbody(text.rows.map(row => tr(row.zipWithIndex.map((cell, column) => td(side(column), cell)))))
      )
    )

  private def aborts(set: FlightSet): Seq[TypedTag[String]] =
    for
      summary <- set.flights
      reason  <- summary.aborted
    yield p(cls := "note", s"${summary.flight.id} ended before its time: $reason")

  private def parameters(set: FlightSet): TextTable =
    TextTable(
      Vector(
        "<flight",
        "<loop",
        "<link",
        "seed",
        "period ms",
        "duration s",
        "<clock",
        "<simulator",
        "<scenario"
      ) ++
        Vector("<version", "<started (UTC)"),
      (set.flights ++ set.twins.flatMap(_.virtual)).map(_.flight).distinct.map: flight =>
        Vector(
          flight.id,
          flight.loop,
          flight.link,
          flight.seed.toString,
          SummaryTables.brief(flight.period.toMillis),
          SummaryTables.brief(flight.duration.toSeconds),
          flight.clock,
          flight.simulator,
          flight.scenario,
          flight.version,
          java.time.Instant.ofEpochSecond(flight.startedAt.toNanos / 1_000_000_000L).toString
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
