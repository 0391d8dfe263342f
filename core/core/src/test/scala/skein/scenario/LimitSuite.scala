package skein.scenario

import skein.units.*

/** Limits and measures of two vehicles with prescribed tracks, sampled ten times per second. */
class LimitSuite extends munit.FunSuite:

  /** Tracks of two vehicles.
    *
    * @param placeNed position of a vehicle at a time, s; velocities are its differences
    */
  private def flown(seconds: Int)(placeNed: (Int, Double) => Vector3): Tracks =
    val tracks = Vector.tabulate(2): vehicle =>
      Track.ofPositions(
        s"Vehicle${vehicle + 1}",
        "Scout",
        Vector.tabulate(seconds * 10 + 1)(tick =>
          (Instant.Epoch + Span.ofMillis(tick * 100.0), placeNed(vehicle, tick / 10.0))
        )
      )
    Tracks.of(tracks).getOrElse(fail("no tracks"))

  /** The second vehicle passes above the first, 3 m higher at 5 s, at 2 m/s. */
  private val passing = flown(10): (vehicle, second) =>
    if vehicle == 0 then Vector3(0, 0, -10) else Vector3((second - 5) * 2, 0, -13)

  test(
    "separation is measured in space, so vehicles one above the other are apart; horizontal separation is not"
  ):
    assertEquals(Limit.separation(Metres(2.9)).violations(passing).size, 0)
    val Vector(one) = Limit.separation(Metres(3.5)).violations(passing): @unchecked
    assertEquals(one.vehicles, Vector(0, 1))
    // √(3.5² − 3²) m at 2 m/s to either side of 5 s.
    assertEqualsDouble(one.fromS, 5 - math.sqrt(3.25) / 2, 0.03)
    assertEqualsDouble(one.toS, 5 + math.sqrt(3.25) / 2, 0.03)
    assertEqualsDouble(one.worst, 3, 1e-9)
    assertEqualsDouble(one.worstAtS, 5, 0.011)
    assertEqualsDouble(Limit.horizontalSeparation(Metres(1)).violations(passing).head.worst, 0, 1e-9)

  test("every stretch of a violation counts once, for every vehicle"):
    val bobbing =
      flown(10)((vehicle, second) => Vector3(0, vehicle * 50.0, -10 + 2 * math.cos(second * math.Pi)))
    // At 0, 2, 4, 6, 8 and 10 s both are lowest.
    assertEquals(Limit.floor(Metres(9)).violations(bobbing).size, 12)
    assertEquals(Limit.ceiling(Metres(11)).violations(bobbing).size, 10)
    assertEquals(Limit.ceiling(Metres(12.1)).violations(bobbing).size, 0)

  test("a limit of the speed applies to the speed in space"):
    val Vector(one) = Limit.speed(MetresPerSecond(1.9)).violations(passing): @unchecked
    assertEquals(one.vehicles, Vector(1))
    assertEqualsDouble(one.worst, 2, 1e-9)

  test("a fence is a circle or a polygon, which need not be convex; the worst value is the distance outside"):
    val circle = Limit.geofence(north = Metres(0), east = Metres(0), radius = Metres(8))
    assertEquals(
      circle.violations(passing).map(one => (one.vehicles, one.worst.round)),
      Vector((Vector(1), 10L), (Vector(1), 10L))
    )
    val hollow =
      Limit.geofence(Vector((-20, -5), (20, -5), (20, 5), (4, 5), (4, -1), (2, -1), (2, 5), (-20, 5)).map(
        (n, e) => (Metres(n), Metres(e))
      ))
    val Vector(in) = hollow.violations(passing): @unchecked
    assertEqualsDouble(in.fromS, 6, 0.03)
    assertEqualsDouble(in.toS, 7, 0.03)
    assertEqualsDouble(in.worst, 1, 0.03)

  test("a rectangular fence must have an inside"):
    val fence = Fence.rectangle(-1, 3, -2, 2)
    assertEquals((fence.beyondM(0, 0), fence.beyondM(5, 0), fence.beyondM(6, -6)), (-1.0, 2.0, 5.0))
    for (minN, maxN, minE, maxE) <-
        Seq((1.0, 1.0, 0.0, 2.0), (2.0, 1.0, 0.0, 2.0), (0.0, 2.0, 1.0, 1.0), (0.0, 2.0, 1.0, 0.0))
    do
      intercept[IllegalArgumentException](Fence.rectangle(minN, maxN, minE, maxE))

  test("a user's own limit has a name, a unit and a bound"):
    val above = Limit.least("height over the hill", "m", 2)((tracks, vehicle) =>
      instant => tracks.altitudeM(vehicle, instant) - 9
    )
    assertEquals(above.text, "height over the hill of at least 2 m")
    assertEquals(Limit.floor(Metres(16 / 3.0)).text, "altitude of at least 5.33333 m")
    assertEquals(Limit.ceiling(Metres(12_345_678)).text, "altitude of at most 12345678 m")
    assertEquals(above.violations(passing).map(_.vehicles), Vector(Vector(0)))

  test("measures reduce a series over the whole flight or over a part of it"):
    val apart                           = Series("apart", "m")(tracks => tracks.separationM(0, 1, _))
    def value(measure: Measure): Double = measure.of(passing).getOrElse(fail("no value"))
    assertEqualsDouble(value(apart.least("closest")), 3, 1e-9)
    assertEqualsDouble(value(apart.leastAt("at")), 5, 0.011)
    assertEqualsDouble(value(apart.most("furthest", Window.After(5))), math.sqrt(109), 1e-6)
    assertEqualsDouble(value(apart.timeBelow("near", 5)), 4, 0.05)
    assertEqualsDouble(value(apart.firstBelow("near from", 5)), 3, 0.03)
    assertEquals(apart.mean("later", Window.Last(11)).of(passing), None)
    assertEquals(apart.firstBelow("touching", 1).of(passing), None)
    assertEquals(value(apart.timesBelow("passes", 5)), 1.0)
    assertEquals(value(apart.timesAbove("partings", 5)), 2.0)
    assertEquals(apart.timesBelow("passes", 5).title, "passes")
    assert(apart.timesBelow("passes", 5).isCount)
    assertEquals(apart.least("closest").title, "closest m")

  test("a measure joins others, of which some may have no value"):
    val apart                 = Series("apart", "m")(tracks => tracks.separationM(0, 1, _))
    def both(bounds: Double*) =
      Measure.join("reached", "", bounds.map(apart.firstBelow("first", _)).toVector, isCount = true)(times =>
        Some(times.flatten.size)
      ).of(passing)
    assertEquals((both(5, 4), both(5, 1), both(1)), (Some(2.0), Some(1.0), Some(0.0)))
