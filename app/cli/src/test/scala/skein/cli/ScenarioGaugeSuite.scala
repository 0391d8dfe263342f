package skein.cli

import skein.figures.ScenarioFigureSuite.Capped
import skein.policy.Agent
import skein.record.Samples
import skein.scenario.{Bound, Crossing, Scenario, Series}
import skein.units.*

class ScenarioGaugeSuite extends munit.FunSuite:
  import ScenarioGaugeSuite.*

  private val start = 1_000_000_000L

  /** A reading of a vehicle that climbs at 1 m/s. */
  private def reading(number: Int, vehicle: String) =
    val sample = Samples.reading(number, vehicle)
    val at     = Instant.ofNanos(start + number * 100_000_000L)
    sample.copy(state =
      sample.state.copy(
        value = sample.state.value.copy(positionNed = Vector3(number * 0.1, 0, -number * 0.1)),
        validAt = at
      )
    )

  private def gauge(scenario: Scenario, most: Int = 1000, clock: Clock = () => Instant.ofNanos(0)) =
    ScenarioGauge(scenario, Vector("A", "B"), clock, most)

  private def fly(gauge: ScenarioGauge, steps: Range): Unit =
    for step <- steps; vehicle <- Seq("A", "B") do gauge.see(reading(step, vehicle))

  test("a scenario's series are sent point by point, each point once, with the series' bound"):
    val told = gauge(Climbing)
    fly(told, 0 to 10)
    val first = ujson.read(told.json().get)("series")(0)
    assertEquals((first("title").str, first("bound")("value").num), ("climbed, m", 2.0))
    val points = first("points").arr.map(point => (point(0).num, point(1).num))
    for (at, climbed) <- points do assertEqualsDouble(climbed, at, 1e-6)
    assertEqualsDouble(points.last._1, 1, 1e-9)
    fly(told, 11 to 20)
    val later = ujson.read(told.json().get)("series")(0)("points").arr.map(_(0).num)
    assert(later.head > points.last._1 && later.last > 1.9, later)

  test("a broken limit is reported with its worst value and its vehicles, until the flight's end"):
    val told     = gauge(Capped(1.5))
    def limits() = ujson.read(told.json().get)("limits").arr
    fly(told, 0 to 10)
    assertEquals(limits().map(_("stretches").num.toInt).toVector, Vector(0, 0))
    fly(told, 11 to 20)
    val ceiling = limits()(0)
    assertEquals((ceiling("text").str, ceiling("altitudeM").num), ("altitude of at most 1.5 m", 1.5))
    assertEquals((ceiling("stretches").num.toInt, ceiling("worst").str), (2, "2.0 m"))

  test("beyond the limit every second reading is dropped, and before all vehicles were read nothing is sent"):
    val told = gauge(Climbing, most = 100)
    told.see(reading(0, "A"))
    assertEquals(told.json(), None)
    fly(told, 1 to 1000)
    assert(told.kept <= 100 && told.kept >= 40, told.kept)
    assertEqualsDouble(ujson.read(told.json().get)("series")(0)("points").arr.last(0).num, 99.8, 3)

  test("a long computation is followed by a long pause"):
    var now  = 0L
    val slow = gauge(Climbing, clock = () => { now += 10_000_000L; Instant.ofNanos(now) })
    fly(slow, 0 to 10)
    assert(slow.json().isDefined)
    fly(slow, 11 to 20)
    assertEquals(slow.json(), None)
    now += 200_000_000L
    assert(slow.json().isDefined)

  test("a scenario whose code fails is reported once, and not computed again"):
    val told = gauge(Failing)
    fly(told, 0 to 10)
    assertEquals(ujson.read(told.json().get)("failed").str, "no such thing")
    assertEquals(told.json(), None)

object ScenarioGaugeSuite:
  private case object Climbing extends Scenario:
    def agents: Vector[Agent]           = Crossing(vehicles = 2, streams = 2).agents
    override def series: Vector[Series] = Vector(
      Series("climbed", "m", Some(Bound("most", 2)))(tracks => instant => tracks.altitudeM(0, instant))
    )

  private case object Failing extends Scenario:
    def agents: Vector[Agent]           = Climbing.agents
    override def series: Vector[Series] = Vector(Series("wrong", "m")(_ => sys.error("no such thing")))
