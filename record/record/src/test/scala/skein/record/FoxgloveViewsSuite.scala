package skein.record

import skein.mcap.Bytes
import skein.scene.SceneFile
import skein.units.*
import skein.vehicle.VehicleKind

/** Scenes according to the definitions of Foxglove's schemas: a line strip is type 0, a lifetime of 0 is
  * infinite, colours are between 0 and 1, and the identity quaternion is 1 in `w` and 0 elsewhere.
  */
class FoxgloveViewsSuite extends munit.FunSuite:
  private val names = Vector("Pursuer", "Evader") ++ (3 to 6).map(number => s"Vehicle$number")
  private val views = FoxgloveViews(names, Some(Span.Zero))
  private val drawn = views.opening(Samples.at(0))
  private val still = ujson.Obj("x" -> 0.0, "y" -> 0.0, "z" -> 0.0, "w" -> 1.0)

  private def read(view: FoxgloveViews.View)         = ujson.read(view.json)
  private def entity(view: FoxgloveViews.View)       = read(view)("entities")(0)
  private def place(x: Double, y: Double, z: Double) = ujson.Obj("x" -> x, "y" -> y, "z" -> z)
  private def pose(x: Double, y: Double, z: Double)  =
    ujson.Obj("position" -> place(x, y, z), "orientation" -> still)

  test("a vehicle is a body in its own frame, with its name above it, for the whole flight"):
    val first = entity(drawn(1))
    assertEquals((first("frame_id").str, first("frame_locked").bool), ("Pursuer", true))
    assertEquals(first("lifetime"), ujson.Obj("sec" -> 0, "nsec" -> 0))
    assertEquals(first("cubes")(0)("pose"), pose(0, 0, 0))
    val label = first("texts")(0)
    assertEquals((label("text").str, label("pose")("orientation")), ("Pursuer", still))
    val at = label("pose")("position")
    // Down is positive.
    assert(at("x").num == 0 && at("y").num == 0 && at("z").num < 0, at.toString)

  test("a car is more than twice as long as wide, and stands on the ground in its frame"):
    val seen    = FoxgloveViews(names, Some(Span.Zero))
    val _       = seen.opening(Samples.at(0))
    val told    = VehicleRow.kind("Evader", VehicleKind.Car).get
    val Seq(as) = seen.of(told): @unchecked
    assertEquals(as.topic, drawn(2).topic)
    val (body, before) = (entity(as)("cubes")(0), entity(drawn(2))("cubes")(0))
    assertEquals((entity(as)("id"), body("color")), (entity(drawn(2))("id"), before("color")))
    assert(body("size")("x").num > 2 * body("size")("y").num)
    // Down is positive.
    assertEqualsDouble(body("pose")("position")("z").num, -body("size")("z").num / 2, 1e-9)
    assertEquals(VehicleRow.kind("Evader", VehicleKind.Multirotor), None)
    for other <-
        Seq(ParameterRow("kind.Nobody", "Car"), ParameterRow("kind.Evader", "Boat"), ParameterRow("car", ""))
    do
      assertEquals(seen.of(other).size, 0)

  test("five vehicles have different colours, and the sixth has the colour of the first"):
    val colours = drawn.tail.take(6).map(entity(_)("cubes")(0)("color"))
    assertEquals(colours.distinct.size, 5)
    assertEquals(colours(5), colours(0))
    for colour <- colours do
      assertEquals(colour("a").num, 1.0)
      for part <- Seq("r", "g", "b") do
        assert(colour(part).num >= 0 && colour(part).num <= 1, colour.toString)

  test("a prediction is a line from a vehicle's reading to a body at its predicted position"):
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
    // When the command acts, by the clock offset in the decision, on the controller's clock.
    val acts = (decision.predicted.get.actsAt + decision.trueAge.get.clockOffset).toNanos
    assertEquals(
      seen("timestamp"),
      ujson.Obj("sec" -> (acts / 1_000_000_000L).toInt, "nsec" -> (acts % 1_000_000_000L).toInt)
    )

  test("the frame of north, east, down is drawn in a frame of east, north, up"):
    val turn            = read(drawn.head)("transforms")(0)
    val rotation        = turn("rotation")
    val Seq(x, y, z, w) = Seq("x", "y", "z", "w").map(rotation(_).num): @unchecked
    // The rotation's matrix, by its definition, row by row: north becomes y, east x, down −z.
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

  test("message times are physics' sampling times by the known clock offset, and a log message is a warning"):
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

  test("the world's objects are a scene of boxes and poles, with their positions and sizes"):
    val stands = SceneFile
      .parse(
        """objects = [
          |  { name = House, box = [10, 6, 8], at = [20, -5], yaw-deg = 90, colour = "#ff8000" }
          |  { name = Pole, pole = [0.25, 5], at = [3, 4], colour = "#000000" }
          |]""".stripMargin,
        "here"
      )
      .fold(error => fail(error.message), identity)
    val scene = FoxgloveViews(names, None, stands).opening(Samples.at(0)).find(_.topic == "/scene").get
    val seen  = ujson.read(scene.json)("entities")(0)
    val cube  = seen("cubes")(0)
    assertEquals((seen("frame_id").str, cube("size")), ("world_ned", place(10, 6, 8)))
    assertEquals(cube("pose")("position"), place(20, -5, -4))
    assertEquals(cube("color"), ujson.Obj("r" -> 1.0, "g" -> 128 / 255.0, "b" -> 0.0, "a" -> 1))
    assertEqualsDouble(cube("pose")("orientation")("z").num, math.sqrt(0.5), 1e-15)
    val pole = seen("cylinders")(0)
    assertEquals((pole("size")("z").num, pole("pose")("position")("z").num), (5.0, -2.5))
    assertEquals(views.opening(Samples.at(0)).find(_.topic == "/scene"), None)

  test("a plan is a line along its course, at the vehicle's height"):
    val seen = FoxgloveViews(names, Some(Span.Zero))
    seen.of(Samples.reading(1)): Unit
    val planned = Samples.oneOfEach.collectFirst { case one: Planned => one }.get
    val plan    = seen.of(planned).head
    assertEquals(plan.topic, "/vehicles/Pursuer/plan")
    assertEquals(
      entity(plan)("lines")(0)("points").arr.toVector,
      Vector[ujson.Value](place(1.5, -0.5, -20.3), place(2.5, 0.25, -20.3))
    )

  test("a ball at a vehicle's predicted position has the size of its newest prediction error"):
    val seen  = FoxgloveViews(names, Some(Span.Zero))
    val guess = Samples.oneOfEach.collectFirst { case one: Prediction => one }.get
    seen.of(guess.copy(vehicle = "Pursuer", error = Metres(0.75))): Unit
    val drawn = entity(seen.of(Samples.decision(1)).head)
    assertEquals(drawn("spheres")(0)("size"), place(1.5, 1.5, 1.5))
    assertEquals(drawn("spheres")(0)("pose"), drawn("cubes")(0)("pose"))

  test("a camera's image is raw, in a frame of right, down, front, and its lens is sent once"):
    val seen                             = FoxgloveViews(names, Some(Span.Zero))
    val Vector(image, frame, calibrated) = seen.of(Samples.image(1)): @unchecked
    val bytes                            = Protobuf.bytesOf(Bytes.of(image.make()), 6).get
    assertEquals(image.topic, "/vehicles/Pursuer/front_center/image")
    assertEquals(Blob.of(bytes.toArray), Samples.image(1).pixels)
    assertEquals(Protobuf.bytesOf(Bytes.of(image.make()), 4).map(_.utf8), Some("bgr8"))
    val moved = ujson.read(frame.json)("transforms")(0)
    assertEquals(moved("child_frame_id").str, "Pursuer/front_center")
    val lens = ujson.read(calibrated.json)
    // 40 pixels cover 1.5 rad.
    assertEqualsDouble(lens("K")(0).num, 20 / math.tan(0.75), 1e-9)
    assertEquals((lens("K")(2).num, lens("K")(5).num), (20.0, 15.0))
    assertEquals(lens("frame_id"), moved("child_frame_id"))
    assertEquals(seen.of(Samples.image(2)).size, 2)

  test("a camera that looks north has its frame's right to the east and its front to the north"):
    val level = Samples.image(1).copy(orientation = Quaternion(1, 0, 0, 0))
    val turn  = ujson.read(FoxgloveViews(names, None).of(level)(1).json)("transforms")(0)("rotation")
    assertEquals(turn, ujson.Obj("x" -> 0.5, "y" -> 0.5, "z" -> 0.5, "w" -> 0.5))

  test("a cloud has its points unchanged, in the lidar's frame, and is thinned if there are too many"):
    val topics = FoxgloveViews(names, Some(Span.Zero)).of(Samples.cloud(1))
    assertEquals(topics.map(_.topic), Vector("/vehicles/Evader/Lidar/cloud"))
    def points(most: Int) =
      Protobuf.bytesOf(Bytes.of(ImageEncoding.cloud(Samples.cloud(1), Instant.Epoch, most)), 6).get.toArray
    assertEquals(Blob.of(points(3)), Samples.cloud(1).xyz)
    assertEquals(
      points(2).toVector,
      Samples.cloud(1).xyz.bytes.toVector.take(12) ++ Samples.cloud(1).xyz.bytes.takeRight(12)
    )
