package skein.report

import skein.measure.FlightSet
import skein.record.*
import skein.scenario.Scenarios
import skein.units.*

/** A report on flights without a result, and on flights that a busy machine disturbed. */
class NoResultSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  private val paused = SyntheticFlight("paused", "none", seed = 1, seconds = 12)
  private val stream = SyntheticFlight("stream", "vpn", seed = 2, seconds = 12)

  /** The recording as if the simulator's clock had shown another time, s since its begin. */
  private def shown(recording: Recording)(clockS: Double => Double): Recording =
    val begun = recording.readings.map(_.state.validAt).min
    recording.copy(readings = recording.readings.map(reading =>
      val at = reading.state.validAt.since(begun).toSeconds
      reading.copy(state = reading.state.copy(validAt = begun + Span.ofSeconds(clockS(at))))
    ))

  private def noted(recording: Recording, kind: EventKind, detail: String): Recording =
    recording.copy(events =
      recording.events :+ Event(recording.readings.last.state.receivedAt, kind, None, detail)
    )

  private def row(set: FlightSet, loop: String): Map[String, String] =
    val table  = SummaryTables.distances(set)
    val values = table.rows.find(_.head.startsWith(loop)).getOrElse(fail(s"no row of $loop"))
    table.header.map(_.stripPrefix("<")).zip(values).toMap

  private def assertEmpty(set: FlightSet, loop: String, why: String): Unit =
    val shown = row(set, loop)
    assertEquals(shown.removedAll(Seq("loop", "link", "paper m")).values.toSet, Set(""), shown.toString)
    assert(SummaryTables.remarks(set).exists(line => line.contains("has no result: ") && line.contains(why)))
    assert(ReportSections.text(set).contains("has no result: "))
    assertEquals(set.deviations, Vector.empty)

  test("a flight whose clock runs backwards, stops, leaps or drifts has no figures, and states why"):
    for
      (clock, why) <- Seq[(Double => Double, String)](
        (s => if s < 6 then s else 12 - s, "the simulator's clock "),
        (s => s.min(6), "the simulator's clock "),
        (s => if s < 6 then s else s + 4, "the simulator's clock "),
        (s => if s < 6 then s else s + 1e9, "the simulator's clock "),
        (s => s * 0.8, "the simulator's clock ")
      )
    do
      val set = Report.of(Seq(paused, shown(stream)(clock)))
      assertEmpty(set, "stream, no result: clock broken", why)
      val ages = SummaryTables.observations(set)
      val row  = ages.rows.find(_.head.startsWith("stream")).get
      assertEquals(row(ages.header.indexOf("true own")), "")

  test("positions over a time that is not the flight's are no result"):
    val truths =
      for s <- Vector(0.0, 12.0, 1e9); vehicle <- stream.heading.vehicles
      yield Truth(vehicle.name, Instant.Epoch + Span.ofSeconds(s), Vector3.Zero)
    val set = Report.of(Seq(paused, stream.copy(truths = truths)))
    assertEmpty(set, "stream, no result: clock broken", "advanced by 1000000000 s in a flight of 12 s")

  test("a paused flight whose clock runs back, leaps or stands still is not a reference"):
    for
      (clock, why) <- Seq[(Double => Double, String)](
        (s => if s < 6 then s else 12 - s, "ran back by"),
        (s => s.min(3), "stood still"),
        (s => if s < 6 then s else s + 4, "advanced by")
      )
    do
      assertEmpty(Report.of(Seq(shown(paused)(clock), stream)), "paused, no result: clock broken", why)

  test("a removed vehicle leaves no figures in any scenario's table, either"):
    val why = "the simulator at host:1 no longer gives Evader to this flight"
    assertEmpty(
      Report.of(Seq(paused, noted(stream, EventKind.VehicleTaken, why))),
      "stream, no result: vehicle taken",
      why
    )

  test("negative ages of earlier recordings are not shown as data"):
    val set = Report.of(Seq(stream.copy(decisions =
      stream.decisions.zipWithIndex.map((one, index) =>
        if index != 40 then one
        else
          one.copy(trueAge =
            one.trueAge.map(_.copy(own = Span.ofMillis(-30.7), opponent = Span.ofMillis(-1)))
          )
      )
    )))
    val least =
      set.flights.flatMap(_.roles).flatMap(role => role.ownTrueAgeMs ++ role.opponentTrueAgeMs).map(_.least)
    assert(least.size == 4 && least.forall(_ > 0), least.toString)

  test("a flight on a machine that was too busy is marked, and not compared"):
    val why = "the machine was too busy: 17 % of 600 ticks came more than 20 ms late, one 310 ms"
    val set = Report.of(Seq(paused, noted(stream, EventKind.Starved, why)))
    val one = row(set, "stream")
    assertEquals((one("loop"), one("vs paused")), ("stream, starved", "starved"))
    assert(one("last 10 s m").nonEmpty, "it did fly")
    assertEquals(set.deviations, Vector.empty)
    assert(SummaryTables.remarks(set).exists(_.contains(s"is not compared with other flights: $why")))
    assert(TimingVerdict.sentence(set).exists(_.contains("stream, starved over vpn is not judged")))

  test("one sentence states whether the timing is bad, compared with the paused flight if there is one"):
    val deviation = Report.of(Seq(paused, stream)).deviations.head.share.mean.abs
    val said      = TimingVerdict.sentence(Report.of(Seq(paused, stream)))
    val word      = if deviation > 0.05 then "bad" else "good"
    assert(
      said.exists(_.startsWith(s"With 5 % as the limit, timing is $word for stream over vpn (")),
      said.toString
    )
    assertEquals(TimingVerdict.sentence(Report.of(Seq(paused))), None)

  test("deviations of different signs do not make good for one another"):
    assertEquals(TimingVerdict.off(Vector(0.125, -0.125)), Some(0.125))
    assertEquals(TimingVerdict.off(Vector.empty), None)

  test(
    "without a paused flight, timing is assessed by the distance from a reading to its command's arrival"
  ):
    val none = SyntheticFlight("stream", "none", seed = 3, seconds = 12)
    val said = TimingVerdict.sentence(Report.of(Seq(stream, none))).getOrElse(fail("nothing was said"))
    assert(said.contains("timing is probably bad for stream over vpn (a vehicle flies on for "), said)
    assert(said.contains(" and probably good for stream over none ("), said)
    assert(said.contains(" between vehicles, before a command answers to what was read"), said)
    assertEquals(said.count(_ == '\n'), 0)
    assert(ReportSections.text(Report.of(Seq(stream, none))).endsWith(said))

  test("loops with one verdict over several links are listed once"):
    val all =
      for loop <- Seq("futures", "stream"); link <- Seq("vpn", "direct")
      yield SyntheticFlight(loop, link, seed = 10, seconds = 12)
    val said = TimingVerdict.sentence(Report.of(all)).getOrElse(fail("nothing was said"))
    assert(said.contains(" for futures and stream over direct and vpn (at worst "), said)

  test("loops with equal verdicts are listed together for each link, with the worst of them"):
    val all =
      for
        (loop, index) <- Seq("sequential", "futures", "stream").zipWithIndex
        link          <- Seq("vpn", "none")
      yield SyntheticFlight(loop, link, seed = 10L + index, seconds = 12)
    val said = TimingVerdict.sentence(Report.of(all)).getOrElse(fail("nothing was said"))
    assert(
      said.contains("timing is probably bad for sequential, futures and stream over vpn (at worst "),
      said
    )
    assert(said.contains(") and probably good for sequential, futures and stream over none (at worst "), said)
    assertEquals(said.sliding("before a command answers".length).count(_ == "before a command answers"), 2)
