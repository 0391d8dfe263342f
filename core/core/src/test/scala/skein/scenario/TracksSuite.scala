package skein.scenario

import skein.policy.Role
import skein.units.*

/** Tracks and their measures, for flights with simple numbers. */
class TracksSuite extends munit.FunSuite:

  private def s(seconds: Double) = Instant.Epoch + Span.ofSeconds(seconds)

  private def flying(name: String, fromS: Double, toS: Double, northMps: Double, eastM: Double = 0) =
    Track.ofPositions(
      name,
      "Scout",
      Vector(fromS, toS).map(at => (s(at), Vector3(northMps * at, eastM, -10)))
    )

  private def tracks(all: Track*): Tracks = Tracks.of(all.toVector).getOrElse(fail("no tracks"))

  test("a track is straight between near samples, and constant before the first and after the last"):
    val track = Track.of(
      "One",
      "Leader",
      Vector(
        (s(1.4), Vector3(5, 1, -2), Vector3(4, 0, 0)),
        (s(1), Vector3(1, 0, -1), Vector3(2, 0, 0)),
        (s(1), Vector3(9, 9, 9), Vector3.Zero)
      )
    )
    for (at, x) <- Seq(0.0 -> 1.0, 1.0 -> 1.0, 1.1 -> 2.0, 1.4 -> 5.0, 4.0 -> 5.0) do
      assertEqualsDouble(track.at(s(at)).x, x, 1e-9)
    assertEqualsDouble(track.velocityAt(s(1.2)).x, 3, 1e-9)
    assertEquals((track.from, track.to), (s(1), s(1.4)))
    assert(track.isA(Role.Leader) && !track.isA(Role.Follower))

  test("velocities that were not measured are those of a parabola through three samples, at ends of a line"):
    val track = Track.ofPositions(
      "One",
      "Scout",
      Vector((s(0), Vector3.Zero), (s(2), Vector3(4, 0, 0)), (s(3), Vector3(4, 5, 0)))
    )
    assertEquals(track.velocitiesNed.head, Vector3(2, 0, 0))
    assertEquals(track.velocitiesNed.last, Vector3(0, 5, 0))
    assertEqualsDouble((track.velocitiesNed(1) - Vector3(2.0 / 3, 10.0 / 3, 0)).norm, 0, 1e-12)
    val falling = Vector(0.0, 0.7, 1.0, 2.5, 3.0).map(t => (s(t), Vector3(0, 0, 4.9 * t * t)))
    for (at, velocity) <-
        falling.map(_._1).zip(Track.ofPositions("One", "Scout", falling).velocitiesNed).slice(1, 4)
    do
      assertEqualsDouble(velocity.z, 9.8 * at.since(s(0)).toSeconds, 1e-9)
    assertEquals(
      Track.ofPositions("One", "Scout", Vector((s(0), Vector3.Zero))).velocitiesNed,
      Vector(Vector3.Zero)
    )

  test("vehicles are compared every 20 ms, over the time in which all were read"):
    val both = tracks(flying("One", 0, 2, 1), flying("Two", 0.5, 3, 2, eastM = 4))
    assertEquals((both.instants.size, both.lastS, both.stepS), (76, 1.5, 0.02))
    assertEqualsDouble(both.northM(0)(0), 0.5, 1e-9)
    // At 1 s: 1 m and 2 m north.
    assertEqualsDouble(both.distanceM(0, 1, 25), math.sqrt(17), 1e-9)
    assertEqualsDouble(both.distanceM(0, 1, 0, 25), 0, 1e-9)
    assertEquals(both.positions(25).count, 2)
    assertEqualsDouble(both.positions(25).distanceM(1, 0), math.sqrt(17), 1e-9)
    assertEquals(both.altitudeM(1, 3), 10.0)
    assertEquals(both.velocityNed(1, 10), Vector3(2, 0, 0))
    assertEquals(both.first(1).instants.size, 101)
    assert(both.first(2) eq both)

  test("vehicles that were never read at one time have no common tracks"):
    assertEquals(Tracks.of(Vector(flying("One", 0, 1, 1), flying("Two", 1, 2, 1))), None)
    assertEquals(Tracks.of(Vector.empty), None)

  test(
    "the deviation of two flights is computed over their common time, and includes the altitude on request"
  ):
    def at(height: Double, seconds: Double) =
      tracks(Track.ofPositions("One", "Scout", Vector(0.0, seconds).map(t => (s(t), Vector3(3, 0, -height)))))
    val off = tracks(Track.ofPositions("One", "Scout", Vector(0.0, 9.0).map(t => (s(t), Vector3(6, 0, -14)))))
    assertEqualsDouble(at(10, 2).rmsFrom(off, inSpace = true), 5, 1e-9)
    assertEqualsDouble(off.rmsFrom(at(10, 2), inSpace = false), 3, 1e-9)

  test(
    "a window is a part of a flight; a flight that is too short has no last seconds, but is measured " +
      "whole otherwise"
  ):
    val flight             = tracks(flying("One", 0, 10, 1))
    def of(window: Window) = window.of(flight).map(range => (range.head, range.last))
    assertEquals(of(Window.Whole), Some((0, 500)))
    assertEquals(of(Window.After(4)), Some((200, 500)))
    assertEquals(of(Window.After(11)), Some((0, 500)))
    assertEquals(of(Window.Last(2)), Some((400, 500)))
    // A flight of 10 s that lost half a second at its ends still has its last 10.5.
    assertEquals(of(Window.Last(10.5)), Some((0, 500)))
    assertEquals(of(Window.Last(10.6)), None)

  test("reductions of the values 3, 4 and 8"):
    val values                   = Vector(3.0, 4.0, 8.0)
    def of(reduction: Reduction) = reduction.of(values, 10.0 + _, 1)
    assertEquals(of(Reduction.Mean), 5.0)
    assertEqualsDouble(of(Reduction.Rms), math.sqrt(89 / 3.0), 1e-12)
    assertEqualsDouble(of(Reduction.Sd), math.sqrt(14 / 3.0), 1e-12)
    assertEquals((of(Reduction.Least), of(Reduction.Most)), (3.0, 8.0))
    assertEquals(of(Reduction.Entries), 1.0)

  test("entries count how often values come to be above 0, from the first one on"):
    def of(values: Double*) = Reduction.Entries.of(values.toVector, _.toDouble, 1)
    assertEquals(of(-1, 2, 3, 0, 1, Double.NaN, 4, -2), 3.0)
    assertEquals((of(1, -1), of(-1, 0)), (1.0, 0.0))

  private def positions(northEastM: (Double, Double)*) = Positions(
    IArray.from(northEastM.map(_._1)),
    IArray.from(northEastM.map(_._2)),
    IArray.fill(northEastM.size)(-5.0)
  )

  test("quantities of positions: deviation from the ring, widest gap, smallest separation"):
    val around = positions((1, 1), (1, 6), (1, -6), (-6, 1))
    // 5, 7 and 7 m from the evader.
    assertEqualsDouble(OffRing(6).of(around), 1, 1e-9)
    assertEqualsDouble(OffRing(5).of(around), math.sqrt(8 / 3.0), 1e-9)
    assertEqualsDouble(WidestGap.of(around), 180, 1e-9)
    assertEqualsDouble(WidestGap.of(positions((0, 0), (5, 0), (5, 5), (0, 5))), 270, 1e-9)
    assertEqualsDouble(WidestGap.of(positions((0, 0), (0, 5), (-5, 0), (0, -5), (5, 0))), 90, 1e-9)
    assertEqualsDouble(Separation.of(around), 5, 1e-9)
    assertEqualsDouble(Separation.of(positions((0, 0), (9, 0), (40, 0), (43, 4))), 5, 1e-9)

  test("slots turn with the leader: on the way back, ahead is south and right is west"):
    val circuit = Formation(straightM = 50, radiusM = 20).circuit
    val slots   = OffSlots(circuit, IArray(-4.0, -4.0), IArray(4.0, -4.0))
    assertEqualsDouble(slots.of(positions((25, 0), (21, 4), (21, -4))), 0, 1e-9)
    assertEqualsDouble(slots.of(positions((25, 40), (29, 36), (29, 44))), 0, 1e-9)
    assertEqualsDouble(slots.of(positions((25, 40), (29, 36), (32, 44))), math.sqrt(4.5), 1e-9)

  test("measures of a series: time of the maximum, time below a value, root mean square, standard deviation"):
    val flight = tracks(flying("One", 0, 10, 1), flying("Two", 0, 10, -1))
    val apart  = Series("apart", "m")(tracks => tracks.distanceM(0, 1, _))
    assertEquals(apart.mostAt("at").of(flight), Some(10.0))
    assertEqualsDouble(apart.mean("mean").of(flight).get, 10, 1e-9)
    // Of a line from 0 to 20: 20 / √3, and 20 / √12 about its middle.
    assertEqualsDouble(apart.rms("rms").of(flight).get, 20 / math.sqrt(3), 0.02)
    assertEqualsDouble(apart.sd("sd").of(flight).get, 20 / math.sqrt(12), 0.02)
    assertEqualsDouble(apart.timeBelow("low", 8.001, Window.After(2)).of(flight).get, 2.02, 1e-9)
    assertEqualsDouble(apart.firstAbove("from 12", 12.01).of(flight).get, 6.02, 1e-9)
    assertEqualsDouble(apart.staysAbove("from 12", 12.01).of(flight).get, 6.02, 1e-9)
    assertEquals(apart.staysBelow("below 12", 12).of(flight), None)
    assertEquals(apart.staysBelow("below 30", 30).of(flight), Some(0.0))
    assertEquals(apart.curve(flight).points.last, (10.0, 20.0))
    assertEquals((apart.title, Series("ratio", "")(_ => _ => 1).title), ("apart, m", "ratio"))
    val arrived = Measure.count("arrived")(_.vehicles.size)
    assertEquals((arrived.title, arrived.isCount, arrived.of(flight)), ("arrived", true, Some(2.0)))

  test("a series has gaps where its value is not finite, and measures of such a part have no value"):
    val flight = tracks(flying("One", 0, 10, 1))
    val above3 = Series("log", ""): tracks =>
      instant => StrictMath.log(tracks.northM(0)(instant) - 3).min(tracks.timeS(instant) - 5)
    val gone  = Set(150, 300)
    val holes = Series("holes", "")(_ => instant => if gone(instant) then 1 / 0.0 else 2)
    assertEquals((above3.mean("mean").of(flight), holes.most("most").of(flight)), (None, None))
    assertEquals(above3.mean("mean", Window.Last(5)).of(flight).map(_ > 0), Some(true))
    assertEquals(above3.curve(flight).stretches.map(_.head._1), Vector(3.02))
    assertEquals(holes.curve(flight).stretches.map(_.size), Vector(150, 149, 200))

  test("a result finds its measures by name, and lists violations in the order of their times"):
    final case class Near() extends Scenario:
      def agents            = Vector.empty
      override def measures = Vector(Measure("apart", "m")(tracks => Some(tracks.distanceM(0, 1, 500))))
      override def limits   = Vector(Limit.speed(MetresPerSecond(0.5)), Limit.separation(Metres(4)))
    val flight = tracks(flying("One", 0, 10, 1), flying("Two", 0, 10, 0, eastM = 0))
    val result = Result.of(Near(), flight)
    assertEqualsDouble(result.value("apart").get, 10, 1e-9)
    assertEquals(result.violations.map(_.fromS), result.violations.map(_.fromS).sorted)
    assertEquals(
      result.violations.map(one => (one.limit.name, one.vehicles)),
      Vector("speed" -> Vector(0), "separation" -> Vector(0, 1))
    )
    val error = intercept[IllegalArgumentException](result.value("nearest"))
    assert(error.getMessage.contains("there are: apart"), error.getMessage)

  test("a track is straight between near samples, and follows the velocities through a gap"):
    def circle(everyS: Double) = Track.of(
      "a",
      "pursuer",
      Vector.tabulate(8): number =>
        val turned     = 1.25 * everyS * number
        val (cos, sin) = (StrictMath.cos(turned), StrictMath.sin(turned))
        (
          Instant.Epoch + Span.ofSeconds(everyS * number),
          Vector3(8 * cos, 8 * sin, 0),
          Vector3(-10 * sin, 10 * cos, 0)
        )
    )
    def offM(track: Track) =
      val spanS = track.to.since(track.from).toSeconds
      (0 to 1000).map(step =>
        math.abs(track.at(track.from + Span.ofSeconds(spanS * step / 1000)).norm - 8)
      ).max
    assertEqualsDouble(offM(circle(0.1)), 0.0156, 1e-3)
    assertEqualsDouble(offM(circle(0.5)), 0.387, 1e-2)
    assert(offM(circle(2)) < 1, offM(circle(2)))
    val samples = circle(2)
    for (at, place) <- samples.times.zip(samples.positionsNed) do assert((samples.at(at) - place).norm < 1e-9)
