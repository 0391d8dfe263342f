package skein.report

import skein.figures.TwinFigure
import skein.measure.FlightSummary
import skein.plot.Mark
import skein.scenario.*
import skein.record.*
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** Measures of flights whose vehicles follow given trajectories. */
class TeamMeasuresSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  /** @param placeM position of a vehicle at a time, s: north and east, m */
  private def flown(scenario: Scenario, seconds: Int, loop: String = "stream")(
      placeM: (Int, Double) => (Double, Double)
  ): Recording =
    val agents   = scenario.agents
    val vehicles =
      agents.map(agent => VehicleRow(agent.name, agent.role.toString, agent.speed, agent.startPositionNed))
    val settings = scenario.settings.map((name, value) => ParameterRow(scenario.recordedAs(name), value))
    val flight   = FlightRow(
      s"$loop-none",
      loop,
      "none",
      1,
      Span.ofMillis(100),
      Span.ofSeconds(seconds),
      "virtual",
      Simulator.BuiltIn,
      scenario.name,
      "test",
      Instant.Epoch
    )
    val readings =
      for
        tick             <- 0 to seconds * 10
        (agent, vehicle) <- agents.zipWithIndex
      yield
        val at            = Instant.Epoch + Span.ofMillis(tick * 100.0)
        val (north, east) = placeM(vehicle, tick / 10.0)
        val state = Kinematics(Vector3(north, east, -5), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
        ReadingRow(tick, agent.name, Stamped(state, at, at, at))
    Recording(RecordingHeader(flight, vehicles, settings), readings)

  private def resultOf(recording: Recording): Result =
    FlightSummary.of(recording).result.getOrElse(fail("no result"))

  private def value(result: Result, name: String): Double =
    result.measured.find(
      _.measure.title == name
    ).flatMap(_.value).getOrElse(fail(s"no $name among ${result.measured}"))

  test("surround: the ring's radius, the even gap, and when the evader is between its pursuers"):
    val scenario = Surround(vehicles = 5)
    // Until 4 s all stand within 160°, then at right angles.
    val result = resultOf(flown(scenario, 20): (vehicle, second) =>
      val bearing = if second < 4 then (vehicle - 1) * 53.0 else (vehicle - 1) * 90.0
      val radius  = if vehicle == 0 then 0.0 else 6.0 + vehicle
      (3 + radius * math.cos(bearing.toRadians), -2 + radius * math.sin(bearing.toRadians)))
    assertEqualsDouble(value(result, "ring m"), 8.5, 1e-9)
    assertEqualsDouble(value(result, "nearest m"), 7, 1e-9)
    // 7, 8, 9 and 10 m.
    assertEqualsDouble(value(result, "off ring m"), math.sqrt(6.0 / 4), 1e-9)
    assertEqualsDouble(value(result, "gap °"), 90, 1e-9)
    assertEqualsDouble(value(result, "surrounded after s"), 3.95, 0.06)

  test("a live flight and its twin are compared by the scenario's first measure, in its unit"):
    val scenario = Surround(vehicles = 5)
    val virtual  = flown(scenario, 20)((vehicle, _) => (vehicle * 6.0, 0))
      .copy(decisions = SyntheticFlight("stream", "none", seed = 1, seconds = 20).decisions)
    val live = virtual.copy(heading =
      virtual.heading.copy(flight = virtual.heading.flight.copy(clock = "real"))
    )
    val measure = scenario.measures.head
    val titles  = TwinFigure(Report.of(Seq(live, virtual))).get.shapes.collect:
      case text: Mark.Text if text.bold => text.content
    assert(clue(titles).exists(_.contains(s": ${measure.name} ")))

  test("an evader outside its ring is never surrounded"):
    val result = resultOf(flown(Surround(vehicles = 4), 12)((vehicle, _) =>
      (vehicle.toDouble, vehicle * vehicle.toDouble)
    ))
    assertEquals(result.measured.find(_.measure.title == "surrounded after s").flatMap(_.value), None)

  test("formation: slots are kept on the circuit, except by a follower that is 0.3 m off from 15 s on"):
    val scenario = Formation(vehicles = 3, spacingM = 4)
    val circuit  = scenario.circuit
    val slots    = scenario.slots
    val result   = resultOf(flown(scenario, 20): (vehicle, second) =>
      val place         = second * 2
      val (north, east) = circuit.point(place)
      val heading       = circuit.headingRad(place)
      val (ahead, side) = if vehicle == 0 then (0.0, 0.0) else slots(vehicle - 1)
      val right         = if vehicle == 2 && second >= 15 then side + 0.3 else side
      (
        north + ahead * math.cos(heading) - right * math.sin(heading),
        east + ahead * math.sin(heading) + right * math.cos(heading)
      ))
    assertEqualsDouble(value(result, "largest m"), 0.3, 0.01)
    // One of two followers, half of the counted time.
    assertEqualsDouble(value(result, "slot rms m"), 0.15, 0.005)
    assert(value(result, "at s") >= 14.9)

  test("crossing: the closest pair with its time, each stretch below the minimum once, and arrivals"):
    val scenario = Crossing(vehicles = 3, streams = 2, minimumM = 2)
    val goals    = scenario.goals
    // The first passes the waiting second at 1 m at 5 s; the third is at its goal from 8 s on.
    val result = resultOf(flown(scenario, 12): (vehicle, second) =>
      vehicle match
        case 0 => ((second - 5) * 4, 200.0)
        case 1 => (0.0, 201.0)
        case _ => if second < 8 then (500.0, 500.0) else goals(2))
    assertEqualsDouble(value(result, "closest m"), 1, 1e-9)
    assertEqualsDouble(value(result, "at s"), 5, 0.01)
    assertEquals(value(result, "violations"), 1.0)
    assertEquals(value(result, "arrived"), 1.0)
    assertEqualsDouble(value(result, "to goal s"), 8, 0.1)
    assertEqualsDouble(value(result, "per min"), 7.5, 0.1)

  test("a flight is compared with the paused flight of its own scenario, and by its vehicles' positions"):
    val scenario              = Surround(vehicles = 3)
    def ring(radiusM: Double) = (vehicle: Int, _: Double) =>
      (if vehicle == 0 then 0.0 else if vehicle == 1 then radiusM else -radiusM, 0.0)
    val set = Report.of(
      Seq(
        flown(scenario, 12, "paused")(ring(9)),
        flown(scenario, 12)(ring(10)),
        flown(Surround(vehicles = 3, ringM = 9), 12, "paused")(ring(100)),
        SyntheticFlight("paused", "none", seed = 1, seconds = 12)
      )
    )
    val flights = set.scenarios.head
    val stream  = flights.flights.find(_.summary.flight.loop == "stream").get
    assertEquals(stream.result.measured.head.value, Some(2.0))
    assertEquals(stream.summary.headline, Some(2.0))
    assertEquals(stream.summary.published, None)
    assertEqualsDouble(flights.deviation(stream).get, 1, 1e-9)
    // Two of three vehicles are 1 m off.
    assertEqualsDouble(flights.offTruthM(stream).get, math.sqrt(2.0 / 3), 1e-9)
    assertEquals(set.scenarios.count(_.scenario.name == "surround"), 2)
    assertEquals(set.ofKind("duel").flights.size, 1)
    val text = ReportSections.text(set)
    assert(text.contains("Results: surround") && text.contains("Distance between pursuer and evader"), text)
    val page = HtmlReport.render(set, ReportSections.of(set, ReportFigures.of(set)))
    assert(
      page.contains("Results: surround, ringM 9.0") && page.contains("Surround, ringM 9.0: trajectories")
    )

  test("tables of teams: a row per flight, and one per loop and link with the spread of its flights"):
    val scenario                                = Crossing(vehicles = 3, streams = 2, minimumM = 2)
    val goals                                   = scenario.goals
    def pass(besideM: Double, arrives: Boolean) = (vehicle: Int, second: Double) =>
      vehicle match
        case 0 => ((second - 5) * 4, 200.0)
        case 1 => (0.0, 200.0 + besideM)
        case _ => if arrives && second >= 8 then goals(2) else (500.0, 500.0)
    val set = Report.of(
      Seq(
        flown(scenario, 12, "paused")(pass(3, arrives = true)),
        flown(scenario, 12)(pass(1, arrives = true)),
        flown(scenario, 12)(pass(1.5, arrives = false)),
        flown(scenario, 12)(pass(4, arrives = true))
      )
    )
    val each = ScenarioTables.flights(set.scenarios.head)
    assertEquals(
      each.header.map(_.stripPrefix("<")).take(6),
      Vector("loop", "link", "flown s", "closest m", "vs paused", "at s")
    )
    def column(table: TextTable, name: String) = table.header.map(_.stripPrefix("<")).indexOf(name)
    assertEquals(
      each.rows.map(_.take(5)),
      Vector(
        Vector("paused", "none", "12.0", "3.00", ""),
        Vector("stream", "none", "12.0", "1.00", "-66.7 %"),
        Vector("stream", "none", "12.0", "1.50", "-50.0 %"),
        Vector("stream", "none", "12.0", "4.00", "+33.3 %")
      )
    )
    assertEquals(each.rows.map(_(column(each, "violations"))), Vector("0", "1", "1", "0"))
    assertEquals(each.rows.map(_(column(each, "to goal s"))), Vector("8.00", "8.00", "never", "8.00"))
    assertEquals(each.rows.map(_.last).take(2), Vector("", "1.15")) // one of three is 2 m off

    val spread = ScenarioTables.spread(set.scenarios.head)
    assertEquals(
      spread.rows.map(_.take(3)),
      Vector(Vector("paused", "none", "1"), Vector("stream", "none", "3"))
    )
    val streams = spread.rows.last
    assertEquals(streams(column(spread, "closest m")), "2.17 ± 1.61, 1.00 … 4.00")
    assertEquals(streams(column(spread, "violations")), "2 in 2 flights")
    assertEquals(streams(column(spread, "to goal s")), "8.00 ± 0.00, 8.00 … 8.00, 1 never")
    assertEquals(spread.rows.map(_.size).distinct, Vector(spread.header.size))

  test("tables state that a flight is shorter than the measured window, and 'never' for missing events"):
    val scenario = Surround(vehicles = 3)
    // Both pursuers stand on one side of the evader.
    val beside        = (vehicle: Int, _: Double) => (10.0 * vehicle, 0.0)
    val (short, long) = (flown(scenario, 5)(beside), flown(scenario, 12)(beside))
    val ended         = short.copy(
      heading = short.heading.copy(flight = short.flight.copy(duration = long.flight.duration)),
      ending = Some(Ending(short.flight.startedAt, EndingKind.Completed, None))
    )
    val set                                    = Report.of(Seq(ended, long)).scenarios.head
    val each                                   = ScenarioTables.flights(set)
    def column(table: TextTable, name: String) =
      table.rows.map(_(table.header.map(_.stripPrefix("<")).indexOf(name)))
    assertEquals(column(each, "ring m"), Vector("too short", "15.00"))
    assertEquals(column(each, "surrounded after s"), Vector("never", "never"))
    val spread = ScenarioTables.spread(set)
    assertEquals(column(spread, "ring m"), Vector("15.00, 1 too short"))
    assertEquals(column(spread, "surrounded after s"), Vector("2 never"))

  test("broken limits are listed with vehicles and times, at most the first five of a flight"):
    val scenario            = Crossing(vehicles = 3, streams = 2, minimumM = 2)
    val names               = scenario.agents.map(_.name)
    def beside(m: Double)   = (0.0, 200 + m)
    def far(second: Double) = (500.0 + second, 500.0)
    val once                = flown(scenario, 12): (vehicle, second) =>
      vehicle match
        case 0 => ((second - 5) * 4, 200.0)
        case 1 => beside(1)
        case _ => far(second)
    val often = flown(scenario, 12, "futures"): (vehicle, second) =>
      vehicle match
        case 0 => (10 * math.sin(math.Pi * (second + 0.5)), 200.0)
        case 1 => beside(1)
        case _ => far(second)
    val clean = flown(scenario, 12, "paused")((vehicle, second) => (100.0 * vehicle, second))
    val rows  = ScenarioTables.violations(Report.of(Seq(clean, once, often)).scenarios.head).rows
    val limit = scenario.limits.head.text
    assert(limit.contains("2 m"), limit)
    assertEquals(rows.filter(_.head == "paused"), Vector.empty)
    val of = rows.filter(_.head == "stream")
    assertEquals(
      of,
      Vector(Vector(
        "stream",
        "none",
        limit,
        "1",
        s"${names(0)}, ${names(1)}",
        "4.58",
        "5.42",
        "1.00",
        "5.00"
      ))
    )
    val (first, more) = rows.filterNot(_.head == "stream").splitAt(1)
    assertEquals(first.map(_.take(4)), Vector(Vector("futures", "none", limit, "12")))
    assertEquals(more.map(_.take(4)), Vector.fill(4)(Vector("", "", "", "")))
    assertEquals((first ++ more).map(_.last), Vector("0.50", "1.50", "2.50", "3.50", "4.50"))
