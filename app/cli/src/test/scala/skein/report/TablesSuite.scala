package skein.report

import skein.measure.{
  Deviation,
  Distribution,
  FlightSet,
  FlightSummary,
  TimingObservation,
  PredictionErrors,
  PredictionGroup,
  Truth
}
import skein.figures.ObservationFigure
import skein.plot.Mark
import skein.record.{Event, EventKind, ParameterRow, Planned, Recording}
import skein.scenario.Scenarios
import skein.signal.Stamped
import skein.units.*
import skein.units.Decimals.{brief, fixed}

/** The tables, compared with the flights that they describe. */
class TablesSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  private val paused  = SyntheticFlight("paused", "none", seed = 1, seconds = 12)
  private val streams = Vector(2L, 3L, 4L).map(SyntheticFlight("stream", "vpn", _, seconds = 12))
  private val set     = Report.of(paused +: streams)
  private val means   = set.flights.map(_.distance.get.lastTenSeconds.get.mean)

  private def row(table: TextTable, loop: String): Map[String, String] =
    val values = table.rows.find(_.head == loop).getOrElse(fail(s"no row of $loop"))
    table.header.map(_.stripPrefix("<")).zip(values).toMap

  test("a loop's spread over its flights is compared with the paused flight of equal policies"):
    val table = SpreadTable.of(set.flights)
    assertEquals(
      table.rows.map(_.take(3)),
      Vector(Vector("paused", "none", "1"), Vector("stream", "vpn", "3"))
    )
    val stream = row(table, "stream")
    val flown  = means.tail
    val mean   = flown.sum / 3
    assertEquals(stream("last 10 s m"), mean.fixed(2))
    assertEquals(stream("least"), flown.min.fixed(2))
    assertEquals(stream("most"), flown.max.fixed(2))
    assertEquals(stream("sd"), math.sqrt(flown.map(m => (m - mean) * (m - mean)).sum / 2).fixed(2))
    val percent = 100 * (mean / means.head - 1)
    assertEquals(stream("vs paused"), (if percent < 0 then "" else "+") + percent.fixed(1) + " %")
    assertEquals(row(table, "paused")("vs paused"), "")
    assertEquals(row(table, "paused")("sd"), "")

  test("the paused flight has the flight's own clock if possible, else another, and never other settings"):
    val Vector(truth, flight)                            = set.flights.take(2): @unchecked
    def by(one: FlightSummary, clock: String)            = one.copy(flight = one.flight.copy(clock = clock))
    def truths(of: FlightSummary, among: FlightSummary*) = Truth.among(among).of(of)
    val (live, virtual)                                  = (by(truth, "real"), by(truth, "virtual"))
    assertEquals(truths(by(flight, "real"), virtual, live), Vector(live))
    assertEquals(truths(by(flight, "real"), virtual, flight), Vector(virtual))
    assertEquals(truths(virtual, virtual), Vector.empty)
    val longer = truth.copy(flight = truth.flight.copy(duration = Span.ofSeconds(13)))
    assertEquals(truths(flight, longer, truth.copy(policy = Some("pure-pursuit"))), Vector.empty)
    val off = Truth.among(Vector(virtual)).deviation(flight)
    assertEqualsDouble(off.get, flight.headline.get / truth.headline.get - 1, 1e-12)

  test(
    "flights in other air, by other readings, or with another link between vehicles are rows of their own"
  ):
    def having(recording: Recording, parameters: (String, String)*) =
      recording.copy(heading =
        recording.heading.copy(parameters = parameters.map((name, value) => ParameterRow(name, value)))
      )
    val windy  = "plant" -> "airsim:wind=5"
    val nearer = SyntheticFlight("paused", "none", seed = 7, seconds = 12)
    val table  = SpreadTable.of(Report.of(Seq(
      paused,
      streams(0),
      having(nearer, windy),
      having(streams(1), windy),
      having(streams(2), "sensors"       -> "position=0.3,velocity=0.1,dropout=5%"),
      having(streams(0), "decentralised" -> "true", "knows" -> "positions")
    )).flights)
    assertEquals(
      table.rows.map(row => (row.head, row(2), row.last.nonEmpty)),
      Vector(
        ("paused", "1", false),
        ("paused, plant airsim:wind=5", "1", false),
        ("stream", "1", true),
        ("stream, plant airsim:wind=5", "1", true),
        ("stream, sensors 1", "1", false),
        ("stream, knows positions, decentralised", "1", false)
      )
    )
    val flights = Report.of(Seq(paused, having(nearer, windy), having(streams(1), windy))).flights
    assertEquals(Truth.among(flights).of(flights.last), Vector(flights(1)))

  test("without a paused flight its column is empty, and captures are counted"):
    val stream = row(SpreadTable.of(set.flights.tail), "stream")
    assertEquals(stream("vs paused"), "")
    val closest = set.flights.tail.map(_.distance.get.closest._2)
    assertEquals(stream("captured"), closest.count(_ < 1.5).toString)
    assertEquals(stream("closest m"), (closest.sum / 3).fixed(2))

  test("the deviation of several flights has a spread, and that of a single flight has none"):
    def deviation(shares: Double*) =
      Deviation("stream", "stream", "vpn", "real", Distribution.of(shares).get)
    val table = DeviationTable.of(Vector(deviation(0.1, 0.3), deviation(-0.05)))
    assertEquals(
      table.rows,
      Vector(
        Vector("stream", "vpn", "real", "2", "+20.0", "14.1", "+10.0", "+30.0"),
        Vector("stream", "vpn", "real", "1", "-5.0", "", "-5.0", "-5.0")
      )
    )

  test("events are counted by flight, and a rare kind has a column if any flight has one"):
    val refused = Event(streams.head.flight.startedAt, EventKind.Refused, None, "no")
    val one     = streams.head.copy(events = streams.head.events :+ refused)
    val table   = SummaryTables.counts(Report.of(Seq(paused, one)))
    assertEquals(row(table, "stream")("refused"), "1")
    assertEquals(row(table, "paused")("refused"), "0")
    assertEquals(row(table, "stream")("readings"), one.readings.size.toString)
    assertEquals(row(table, "stream")("commands"), one.commands.size.toString)
    val usual = SummaryTables.counts(Report.of(Seq(paused))).header.map(_.stripPrefix("<"))
    assertEquals(usual.drop(5).toSet, Set("dropped", "skipped", "timed out"))

  test("the text has only the sections with content"):
    val text = ReportSections.text(set)
    for title <- Seq("Distance between pursuer", "Observations per decision", "What happened", "Deviation") do
      assert(text.contains(title), s"no $title")
    for title <- Seq("Prediction error", PlanTable.title, "Live against virtual", "Results: surround") do
      assert(!text.contains(title), s"$title though there is none")

  /** A duel of 20 s whose pursuer is at a given distance north of the evader. */
  private def duel(loop: String, seed: Long)(distanceM: Double => Double): Recording =
    val flight   = SyntheticFlight(loop, "direct", seed, seconds = 20)
    val like     = flight.readings.head
    val sampled  = Instant.Epoch + Span.ofSeconds(100)
    val readings =
      for
        tick    <- (0 to 200).toVector
        vehicle <- flight.heading.vehicles
      yield
        val north = if vehicle.role.toLowerCase == "pursuer" then distanceM(tick / 10.0) else 0.0
        val state = like.state.value.copy(positionNed = Vector3(north, 3, -20))
        val since = Span.ofMillis(100.0 * tick)
        like.copy(
          vehicle = vehicle.name,
          state = Stamped(state, sampled + since, like.state.sentAt + since, like.state.receivedAt + since)
        )
    flight.copy(readings = readings)

  /** A distance that falls by 1 m/s to 1.01 m at 10 s, and then grows by 0.2 m/s. */
  private def pass(more: Double)(second: Double) =
    more + (if second < 10 then 11.01 - second else 1.01 + 0.2 * (second - 10))

  private val steady = duel("paused", 1)(_ => 4.02)

  test("distances: duration, closest approach with its time, the last 10 s, and the paused flight"):
    val table = SummaryTables.distances(Report.of(Seq(steady, duel("stream", 2)(pass(0)))))
    assertEquals(
      table.rows,
      Vector(
        Vector("paused", "direct", "20.0", "4.02", "0.0", "4.02", "0.00", "4.0 … 4.0", "") ++
          Vector("", "", ""),
        Vector("stream", "direct", "20.0", "1.01", "10.0", "2.01", "0.58", "1.0 … 3.0", "-50.0 %") ++
          Vector("", "", "")
      )
    )

  test("spread: of the mean, within a flight, of the closest approach, and the number of captures"):
    val flights = Report.of(Seq(steady, duel("stream", 2)(pass(0)), duel("stream", 3)(pass(1)))).flights
    assertEquals(
      SpreadTable.of(flights).rows.last,
      Vector("stream", "direct", "2", "2.51", "0.71", "2.01", "3.01", "0.58", "1.51", "1", "-37.6 %")
    )

  test("plans: candidates, their time, missed and broken plans, and the time of the capture"):
    def planned(candidates: Long, slices: Vector[Long], tookMs: Double, breaches: Long) =
      Planned("Pursuer", 1, candidates, slices, Some(1), Span.ofMillis(tookMs), breaches)
    val plans = Vector(
      planned(1000, Vector(3, 4), 60, 0),
      planned(500, Vector(2, 2), 62, 1),
      planned(0, Vector(0, 0), 70, 2),
      planned(300, Vector(1, 0), 60, 0)
    )
    val catches = duel("plan", 2)(pass(0)).copy(planned = plans)
    val never   = duel("plan", 3)(pass(1)).copy(planned = plans.take(1))
    val table   = PlanTable.of(Report.of(Seq(steady, catches, never)))
    assertEquals(
      table.rows,
      Vector(
        Vector("plan", "direct", "4", "450", "0", "3.0", "63", "70", "1", "2", "9.5", "14.7 %"),
        Vector("plan", "direct", "1", "1000", "1000", "7.0", "60", "60", "0", "0", "never", "0.0 %")
      )
    )
    assertEquals(table.header.size, table.rows.head.size)
    assert(PlanTable.note(Report.of(Seq(catches))).contains("Captured: when"))

  test("a distance of exactly 1.5 m is not a capture"):
    val plan = Planned("Pursuer", 1, 10, Vector(1), None, Span.ofMillis(50), 0)
    val row  = PlanTable.of(Report.of(Seq(duel("plan", 2)(_ => 1.5).copy(planned = Vector(plan))))).rows.head
    assertEquals(row.takeRight(2), Vector("never", "0.0 %"))
    assertEquals(SpreadTable.of(Report.of(Seq(duel("plan", 2)(_ => 1.5))).flights).rows.head(9), "0")

  test("a live flight is next to its twin with both distances and the difference"):
    val flown = duel("stream", 2)(pass(0))
    val live  = flown.copy(heading = flown.heading.copy(flight = flown.heading.flight.copy(clock = "real")))
    val table = SummaryTables.twins(Report.of(Seq(live, duel("stream", 3)(pass(1)))))
    val shown = table.header.map(_.stripPrefix("<")).zip(table.rows.head).toMap
    assertEquals(table.rows.head.take(4), Vector("stream", "direct", "2", "seed 3"))
    assertEquals((shown("live m"), shown("virtual m"), shown("difference")), ("2.01", "3.01", "-33.2 %"))
    assertEquals(shown("flown otherwise"), "")

  test("plans of a team do not count captures"):
    val unseen = duel("plan", 2)(pass(0)).copy(
      planned = Vector(Planned("Pursuer", 1, 10, Vector(1), None, Span.ofMillis(50), 0)),
      readings = Vector.empty
    )
    val table = PlanTable.of(Report.of(Seq(unseen)))
    assertEquals(table.rows.map(_.size), Vector(table.header.size))
    assert(!table.header.contains("captured at s"), table.header)
    assert(!PlanTable.note(Report.of(Seq(unseen))).contains("captured"))

  test("prediction errors are in mm, and groups without a verified prediction are marked"):
    val own   = PredictionErrors(made = 50, Vector.tabulate(41)(index => (100.0, index * 20 / 1000.0)))
    val none  = PredictionErrors(made = 0, Vector.empty)
    val lost  = PredictionErrors(made = 3, Vector.empty)
    val table = PredictionTable.of(
      Vector(PredictionGroup("predictive", "vpn", own, none), PredictionGroup("plan", "vpn", lost, lost))
    )
    assertEquals(
      table.rows,
      Vector(
        Vector("predictive", "vpn", "own vehicle", "50", "9", "100", "400.0", "760.0", "760.0"),
        Vector("plan", "vpn", "own vehicle", "3", "3", "", "", "", ""),
        Vector("plan", "vpn", "others", "3", "3", "", "", "", "")
      )
    )

  test("observations are next to the paper's for their role, and true ages are means in ms"):
    val recording = SyntheticFlight("stream", "direct", seed = 1)
    val table     = SummaryTables.observations(Report.of(Seq(recording)))
    val paper     = table.header.indices.filter(table.header(_) == "paper")
    assertEquals(
      table.rows.map(row => row(2) +: paper.map(row).toVector),
      Vector(Vector("evader", "26", "25", "79", "81"), Vector("pursuer", "25", "26", "79", "73"))
    )
    for (role, row) <- Seq("Evader", "Pursuer").zip(table.rows) do
      val ages                   = recording.decisions.filter(_.vehicle == role).flatMap(_.trueAge)
      def mean(of: Vector[Span]) = (of.map(_.toMillis).sum / of.size).brief
      assertEquals(row.takeRight(2), Vector(mean(ages.map(_.own)), mean(ages.map(_.opponent))))
    assertEquals(TimingObservation.values.size, paper.size)

  test("without opponents, the columns about them are left out"):
    val duel = SyntheticFlight("stream", "direct", seed = 1, seconds = 12)
    val set  = Report.of(Seq(duel.copy(heading =
      duel.heading.copy(flight = duel.heading.flight.copy(scenario = "surround"))
    )))
    val table = SummaryTables.observations(set)
    assertEquals(
      table.header.map(_.stripPrefix("<")),
      Vector("loop", "link", "for", "own age", "own move", "true own")
    )
    assert(table.rows.nonEmpty && table.rows.forall(_.size == table.header.size))
    val titles = ObservationFigure(set).get.shapes.collect { case text: Mark.Text => text.content }
    assert(titles.contains("Own location age") && !titles.exists(_.contains("pponent")), titles)

  test("without a flight of the paper, observations have no comparison"):
    val slope = SyntheticFlight("stream", "direct", seed = 1, seconds = 12)
    val other = slope.copy(heading =
      slope.heading.copy(flight = slope.heading.flight.copy(scenario = "chase"))
    )
    val table = SummaryTables.observations(Report.of(Seq(other)))
    assert(!table.header.contains("paper"), table.header)
    assert(table.rows.nonEmpty && table.rows.forall(_.size == table.header.size))

  test("the page states the flights' parameters with units, and their start times"):
    val page =
      HtmlReport.render(Report.of(Seq(SyntheticFlight("stream", "direct", seed = 7, seconds = 12))), Nil)
    val row = page.drop(page.indexOf("Run parameters")).split("<tr>").last.replaceAll("<[^>]*>", "|")
    assertEquals(
      row.split("[|]+").filter(_.nonEmpty).toSeq.take(11),
      Seq("stream-direct", "stream", "direct", "7", "100", "12", "virtual", "synthetic", "duel", "0.1.0") :+
        "2026-09-21T14:13:20Z"
    )
    assert(page.contains("Skein: 1 flight, scenario duel"), page.take(400))
    assert(page.contains("one decision per vehicle every 100 ms; simulator synthetic; virtual clock"))

  test("a set names its scenario only if all flights have it"):
    val team  = SyntheticFlight("stream", "vpn", seed = 1, seconds = 12)
    val other = team.copy(heading = team.heading.copy(flight = team.heading.flight.copy(scenario = "own")))
    assert(HtmlReport.render(Report.of(Seq(team, other)), Nil).contains("<h1>Skein: 2 flights</h1>"))

  test("flights are in the paper's order: by link, then by loop"):
    val links     = Seq("vpn", "zebra", "none", "direct")
    val loops     = Seq("stream", "paused", "sequential")
    val summaries =
      for
        link <- links
        loop <- loops
        like = steady.heading
      yield Recording(like.copy(flight = like.flight.copy(loop = loop, link = link)))
    assertEquals(
      FlightSet(Report.of(summaries).flights.reverse).flights.map(one => (one.flight.link, one.flight.loop)),
      for
        link <- Vector("none", "direct", "vpn", "zebra")
        loop <- Vector("paused", "sequential", "stream")
      yield (link, loop)
    )
