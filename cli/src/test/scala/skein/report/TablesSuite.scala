package skein.report

import skein.measure.{Deviation, Distribution, Numbers}
import skein.record.{Event, EventKind}
import skein.scenario.Scenarios

/** What the tables say, held against the flights that they are about. */
class TablesSuite extends munit.FunSuite:
  private given Scenarios = DuelReport.scenarios

  private val paused  = SyntheticFlight("paused", "none", seed = 1, seconds = 12)
  private val streams = Vector(2L, 3L, 4L).map(SyntheticFlight("stream", "vpn", _, seconds = 12))
  private val set     = Report.of(paused +: streams)
  private val means   = set.flights.map(_.distance.get.lastTenSeconds.get.mean)

  private def row(table: TextTable, loop: String): Map[String, String] =
    val values = table.rows.find(_.head == loop).getOrElse(fail(s"no row of $loop"))
    table.header.map(_.stripPrefix("<")).zip(values).toMap

  test("the spread of a loop over its flights stands beside the truth of the same policies"):
    val table = SpreadTable.of(set.flights)
    assertEquals(
      table.rows.map(_.take(3)),
      Vector(Vector("paused", "none", "1"), Vector("stream", "vpn", "3"))
    )
    val stream = row(table, "stream")
    val flown  = means.tail
    val mean   = flown.sum / 3
    assertEquals(stream("last 10 s m"), Numbers.fixed(mean, 2))
    assertEquals(stream("least"), Numbers.fixed(flown.min, 2))
    assertEquals(stream("most"), Numbers.fixed(flown.max, 2))
    assertEquals(stream("sd"), Numbers.fixed(math.sqrt(flown.map(m => (m - mean) * (m - mean)).sum / 3), 2))
    val percent = 100 * (mean / means.head - 1)
    assertEquals(stream("vs paused"), (if percent < 0 then "" else "+") + Numbers.fixed(percent, 1) + " %")
    assertEquals(row(table, "paused")("vs paused"), "+0.0 %")

  test("without a paused flight nothing is said of the truth, and captures are counted"):
    val stream = row(SpreadTable.of(set.flights.tail), "stream")
    assertEquals(stream("vs paused"), "")
    val closest = set.flights.tail.map(_.distance.get.closest._2)
    assertEquals(stream("captured"), closest.count(_ < 1.5).toString)
    assertEquals(stream("closest m"), Numbers.fixed(closest.sum / 3, 2))

  test("a deviation of several flights has a spread, one of a single flight has none"):
    def deviation(shares: Double*) =
      Deviation("stream", "stream", "vpn", "real", Distribution.of(shares).get)
    val table = DeviationTable.of(Vector(deviation(0.1, 0.3), deviation(-0.05)))
    assertEquals(
      table.rows,
      Vector(
        Vector("stream", "vpn", "real", "2", "+20.0", "10.0", "+10.0", "+30.0"),
        Vector("stream", "vpn", "real", "1", "-5.0", "", "-5.0", "-5.0")
      )
    )

  test("what happened is counted by flight; a rare kind of event has a column where any flight has it"):
    val refused = Event(streams.head.flight.startedAt, EventKind.Refused, None, "no")
    val one     = streams.head.copy(events = streams.head.events :+ refused :+ refused)
    val table   = SummaryTables.counts(Report.of(Seq(paused, one)))
    assertEquals(row(table, "stream")("refused"), "2")
    assertEquals(row(table, "paused")("refused"), "0")
    assertEquals(row(table, "stream")("readings"), one.readings.size.toString)
    assertEquals(row(table, "stream")("commands"), one.commands.size.toString)
    val usual = SummaryTables.counts(Report.of(Seq(paused))).header.map(_.stripPrefix("<"))
    assertEquals(usual.drop(5).toSet, Set("dropped", "skipped", "timed out"))

  test("the text has the sections that there is something to say in, and no others"):
    val text = ReportSections.text(set)
    for title <- Seq("Distance between pursuer", "Observations per decision", "What happened", "Deviation") do
      assert(text.contains(title), s"no $title")
    for title <- Seq("Prediction error", PlanTable.title, "Live against virtual", "Results: surround") do
      assert(!text.contains(title), s"$title though there is none")
