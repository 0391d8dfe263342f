package skein.record

import skein.units.*

/** Scenes by the definitions of Foxglove's schemas: a line strip is type 0, a lifetime of 0 is for ever, colours lie
  * between 0 and 1, and the quaternion that turns nothing is 1 in `w` and 0 else.
  */
class FoxgloveViewsSuite extends munit.FunSuite:
  private val names = Vector("Pursuer", "Evader") ++ (3 to 6).map(number => s"Vehicle$number")
  private val views = FoxgloveViews(names, Some(Span.Zero))
  private val drawn = views.opening(Samples.at(0))
  private val still = ujson.Obj("x" -> 0.0, "y" -> 0.0, "z" -> 0.0, "w" -> 1.0)

  private def read(view: FoxgloveViews.View)         = ujson.read(view.json())
  private def entity(view: FoxgloveViews.View)       = read(view)("entities")(0)
  private def place(x: Double, y: Double, z: Double) = ujson.Obj("x" -> x, "y" -> y, "z" -> z)
  private def pose(x: Double, y: Double, z: Double)  =
    ujson.Obj("position" -> place(x, y, z), "orientation" -> still)

  test("a vehicle is a body where its frame is, with its name above it, for as long as the flight"):
    val first = entity(drawn(1))
    assertEquals((first("frame_id").str, first("frame_locked").bool), ("Pursuer", true))
    assertEquals(first("lifetime"), ujson.Obj("sec" -> 0, "nsec" -> 0))
    assertEquals(first("cubes")(0)("pose"), pose(0, 0, 0))
    val label = first("texts")(0)
    assertEquals((label("text").str, label("pose")("orientation")), ("Pursuer", still))
    val at = label("pose")("position")
    // Down is positive.
    assert(at("x").num == 0 && at("y").num == 0 && at("z").num < 0, at.toString)

  test("five vehicles have colours that differ, and the sixth has the first one's again"):
    val colours = drawn.tail.map(entity(_)("cubes")(0)("color"))
    assertEquals(colours.distinct.size, 5)
    assertEquals(colours(5), colours(0))
    for colour <- colours do
      assertEquals(colour("a").num, 1.0)
      for part <- Seq("r", "g", "b") do
        assert(colour(part).num >= 0 && colour(part).num <= 1, colour.toString)

  test("a prediction is a line from where the vehicle was read to a body where it is expected"):
    val decision = Samples.decision(1)
    val expected = decision.predicted.get.ownPositionNed
    val from     = decision.own.state.value.positionNed
    val seen     = entity(views.of(decision).head)
    val line     = seen("lines")(0)
    assertEquals((seen("frame_id").str, line("type").num), ("world_ned", 0.0))
    assertEquals(line("pose"), pose(0, 0, 0))
    assertEquals(
      line("points").arr.toVector,
      Vector[ujson.Value](place(from.x, from.y, from.z), place(expected.x, expected.y, expected.z))
    )
    assertEquals(seen("cubes")(0)("pose"), pose(expected.x, expected.y, expected.z))
    val own = entity(drawn(1))("cubes")(0)("color")
    assertEquals((line("color"), seen("cubes")(0)("color")), (own, own))
    // When the command acts, by the clocks' offset that the decision tells, on the controller's clock.
    val acts = (decision.predicted.get.actsAt + decision.trueAge.get.clockOffset).toNanos
    assertEquals(
      seen("timestamp"),
      ujson.Obj("sec" -> (acts / 1_000_000_000L).toInt, "nsec" -> (acts % 1_000_000_000L).toInt)
    )

  test("the world's frame of north, east, down is drawn in one of east, north, up"):
    val turn            = read(drawn.head)("transforms")(0)
    val rotation        = turn("rotation")
    val Seq(x, y, z, w) = Seq("x", "y", "z", "w").map(rotation(_).num): @unchecked
    // The rotation's matrix, by its definition, row by row: what was north becomes y, what was east x, down −z.
    val rows = Vector(
      Vector(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
      Vector(2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
      Vector(2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y))
    )
    for
      (row, expected) <- rows.zip(Vector(Vector(0, 1, 0), Vector(1, 0, 0), Vector(0, 0, -1)))
      (value, wanted) <- row.zip(expected)
    do assertEqualsDouble(value, wanted.toDouble, 1e-15)
    assertEquals(turn("translation"), place(0, 0, 0))

  test("times of messages are when physics was sampled, by the offset known; a log message is a warning"):
    val reading = Samples.reading(1)
    val offset  = Span.ofSeconds(2.5)
    val pose    = read(FoxgloveViews(names, Some(offset)).of(reading)(1))
    val nanos   = reading.state.validAt.toNanos + 2_500_000_000L
    assertEquals(
      pose("timestamp"),
      ujson.Obj("sec" -> (nanos / 1_000_000_000L).toInt, "nsec" -> (nanos % 1_000_000_000L).toInt)
    )
    val unknown = read(FoxgloveViews(names, None).of(reading)(1))
    val came    = reading.state.receivedAt.toNanos
    assertEquals(unknown("timestamp")("nsec").num, (came % 1_000_000_000L).toDouble)
    val event   = Samples.oneOfEach.collectFirst { case one: Event => one }.get
    val log     = read(views.of(event).head)
    assertEquals((log("level").num, log("name").str), (3.0, "Evader"))
