package skein.record

import java.nio.charset.StandardCharsets.UTF_8
import scala.collection.mutable
import skein.scene.{Placement, Scene, SceneObject, Shape}
import skein.units.*
import skein.vehicle.VehicleKind

/** A flight as messages of Foxglove's schemas, made from the rows in order. Frames: `world` is east, north,
  * up, as viewers draw; `world_ned` north, east, down, as everywhere else in a flight; each vehicle's own is
  * its body, front, right, down. Times in messages are the sampling times of physics, on the controller's
  * clock, by the clock offset known at that time.
  */
private[record] final class FoxgloveViews(
    vehicles: Vector[String],
    firstOffset: Option[Span],
    stands: Scene = Scene.Empty,
    form: ImageEncoding = ImageEncoding.Whole
):
  import FoxgloveViews.*

  private val colours = vehicles.zipWithIndex.map((name, at) => name -> colour(at)).toMap
  private var offset  = firstOffset
  private val trails  = mutable.Map.empty[String, Trail]
  private val downs   = mutable.Map.empty[String, Double]
  private val decided = mutable.Map.empty[String, Instant]
  private val errors  = mutable.Map.empty[String, Metres]
  private val cars    = mutable.Set.empty[String]
  private var opened  = Instant.Epoch
  private val lenses  = mutable.Map.empty[ImagingSensor, (Long, Long, Option[Radians])]

  /** The messages before the first row. */
  def opening(at: Instant): Vector[View] =
    opened = at
    transform(FixedFrames, at, "world", "world_ned", Vector3(0, 0, 0), NedInWorld) +:
      (vehicles.map(drawn) ++ Option.when(stands.objects.nonEmpty)(obstacles(at)))

  def of(record: Record): Vector[View] = record match
    case reading: ReadingRow =>
      // Without a better estimate, as if the first reading had no latency.
      val ahead = aheadOf(reading.state.validAt, reading.state.receivedAt)
      offset = Some(ahead)
      val at    = reading.state.validAt + ahead
      val state = reading.state.value
      val name  = reading.vehicle
      downs(name) = state.positionNed.z
      Vector(
        transform(Frames, at, "world_ned", name, state.positionNed, state.orientation),
        View.text(poseOf(name))(pose(at, state.positionNed, state.orientation))
      ) ++ trail(name, at, state.positionNed)
    case decision: DecisionRow =>
      decision.trueAge.foreach(age => offset = Some(age.clockOffset))
      val name = decision.vehicle
      decided(name) = decision.decidedAt
      decision.predicted.toVector.map: expected =>
        val at   = expected.actsAt + offset.getOrElse(Span.Zero)
        val from = decision.own.state.value.positionNed
        val off  = errors.get(name)
        carried(name, at, from, expected.ownPositionNed, off)
    case event: Event =>
      def log = Json.obj(
        "timestamp" -> time(event.at),
        "level"     -> Warning,
        "message"   -> Json.string(s"${event.kind}: ${event.detail}"),
        "name"      -> Json.string(event.vehicle.getOrElse("flight")),
        "file"      -> "\"\"",
        "line"      -> "0"
      )
      Vector(View.text(Log)(log))
    case prediction: Prediction =>
      if prediction.decider == prediction.vehicle then errors(prediction.vehicle) = prediction.error
      Vector.empty
    case planned: Planned =>
      planned.course.toVector.map: course =>
        val name   = planned.vehicle
        val down   = downs.getOrElse(name, 0.0)
        val places = course.north.zip(course.east).map((north, east) => Vector3(north, east, down))
        val at     = decided.getOrElse(name, Instant.Epoch)
        scene(planOf(name), at, s"$name plan", lines = Vector(line(name, places, thickness = 3)))
    case image: CameraImage => seen(image)
    case cloud: Cloud       =>
      val at = cloud.validAt + aheadOf(cloud.validAt, cloud.receivedAt)
      Vector(View(
        cloudOf(ImagingSensor(cloud.vehicle, cloud.lidar, isLidar = true)),
        () => ImageEncoding.cloud(cloud, at, form.mostPoints)
      ))
    case ParameterRow(s"kind.$name", Car) if colours.contains(name) =>
      cars += name
      Vector(drawn(name))
    case _ => Vector.empty

  /** The controller's clock minus the simulator's: the newest estimate; before the first, this row is assumed
    * to have no latency.
    */
  private def aheadOf(validAt: Instant, receivedAt: Instant): Span =
    offset.getOrElse(receivedAt.since(validAt))

  /** An image with its camera's pose, and with the lens if it is new. */
  private def seen(image: CameraImage): Vector[View] =
    val sensor = ImagingSensor.camera(image.vehicle, image.camera, image.kind)
    val at     = image.validAt + aheadOf(image.validAt, image.receivedAt)
    val frame  = s"${image.vehicle}/${image.camera}"
    val lens   = (image.width, image.height, image.fov)
    val isNew  = !lenses.get(sensor).contains(lens)
    lenses(sensor) = lens
    val calibrated =
      image.fov.filter(_ => isNew).map(fov =>
        View.text(calibrationOf(sensor))(calibration(at, frame, image, fov))
      )
    Vector(
      View(imageOf(sensor), () => form.image(image, at, frame)),
      transform(
        Frames,
        at,
        "world_ned",
        frame,
        image.positionNed,
        times(image.orientation, OpticalInCamera)
      )
    ) ++ calibrated

  /** The calibration of a pinhole without distortion, whose axis passes through the image's middle. */
  private def calibration(at: Instant, frame: String, image: CameraImage, fov: Radians): String =
    val focal                 = image.width / (2 * StrictMath.tan(fov.value / 2))
    val (cx, cy)              = (image.width / 2.0, image.height / 2.0)
    def numbers(all: Double*) = Json.array(all.map(Json.number))
    Json.obj(
      "timestamp"        -> time(at),
      "frame_id"         -> Json.string(frame),
      "width"            -> s"${image.width}",
      "height"           -> s"${image.height}",
      "distortion_model" -> "\"plumb_bob\"",
      "D"                -> numbers(0, 0, 0, 0, 0),
      "K"                -> numbers(focal, 0, cx, 0, focal, cy, 0, 0, 1),
      "R"                -> numbers(1, 0, 0, 0, 1, 0, 0, 0, 1),
      "P"                -> numbers(focal, 0, cx, 0, 0, focal, cy, 0, 0, 0, 1, 0)
    )

  private def obstacles(at: Instant): View =
    lazy val parts =
      stands.objects.flatMap(thing => thing.parts.map(part => (part, thing.place.outside(part.at))))
    scene(
      Standing,
      at,
      "scene",
      cubes = parts.collect:
        case (SceneObject.Part(Shape.Box(half), _, rgb), place)    => block(place, half * 2, painted(rgb))
        case (SceneObject.Part(Shape.Tag(_, side), _, rgb), place) =>
          block(place, Vector3(TagM, side * 5 / 4, side * 5 / 4), painted(rgb))
      ,
      cylinders = parts.collect:
        case (SceneObject.Part(Shape.Pole(radius, half), _, rgb), place) =>
          Json.obj(
            "pose"         -> placed(place.position, place.orientation),
            "size"         -> xyz(Vector3(radius * 2, radius * 2, half * 2)),
            "bottom_scale" -> "1",
            "top_scale"    -> "1",
            "color"        -> painted(rgb)
          )
    )

  private def block(place: Placement, size: Vector3, colour: String) = Json.obj(
    "pose"  -> placed(place.position, place.orientation),
    "size"  -> xyz(size),
    "color" -> colour
  )

  /** The recent track of a vehicle. It is sent whole once a second, so that a viewer has it immediately after
    * a seek.
    */
  private def trail(name: String, at: Instant, position: Vector3): Option[View] =
    val trail = trails.getOrElseUpdate(name, Trail(at))
    trail.points.append((at, position)): Unit
    Option.when(at.since(trail.shownAt) >= TrailEvery):
      trail.shownAt = at
      trail.points.dropWhileInPlace((passed, _) => at.since(passed) > TrailLength): Unit
      val points = trail.points.toVector.map(_._2)
      scene(trailOf(name), at, s"$name trail", lines = Vector(line(name, points, thickness = 2)))

  /** A line from a vehicle's reading to its predicted position when the command acts, with a sphere around
    * that position, of the size of the newest prediction's error.
    */
  private def carried(name: String, at: Instant, from: Vector3, to: Vector3, off: Option[Metres]) = scene(
    predictionOf(name),
    at,
    s"$name prediction",
    cubes = Vector(block(Placement(to), Vector3(0.5, 0.5, 0.5), colours(name))),
    spheres = off.toVector.map(error => block(Placement(to), Vector3(2, 2, 2) * error.value, Doubt)),
    lines = Vector(line(name, Vector(from, to), thickness = 4))
  )

  private def line(name: String, points: Vector[Vector3], thickness: Int) = Json.obj(
    "type"            -> LineStrip,
    "pose"            -> placed(Vector3(0, 0, 0), Quaternion(1, 0, 0, 0)),
    "thickness"       -> thickness.toString,
    "scale_invariant" -> "true",
    "points"          -> Json.array(points.map(xyz)),
    "color"           -> colours(name),
    "colors"          -> "[]",
    "indices"         -> "[]"
  )

  private def drawn(name: String): View =
    scene(bodyOf(name), opened, name, frame = name, cubes = Vector(body(name)), texts = Vector(label(name)))

  /** A vehicle's body; a car's origin is on the ground. */
  private def body(name: String) =
    val (size, middle) =
      if cars(name) then (CarM, Vector3(0, 0, -CarM.z / 2)) else (MultirotorM, Vector3.Zero)
    block(Placement(middle), size, colours(name))

  private def label(name: String) = Json.obj(
    "pose"            -> placed(Vector3(0, 0, if cars(name) then -2.2 else -1), Quaternion(1, 0, 0, 0)),
    "billboard"       -> "true",
    "font_size"       -> "14",
    "scale_invariant" -> "true",
    "color"           -> colours(name),
    "text"            -> Json.string(name)
  )

private[record] object FoxgloveViews:
  /** A message for a topic; its bytes are made on demand. */
  final case class View(topic: String, make: () => Array[Byte]):
    def json: String = String(make(), UTF_8)

  object View:
    def text(topic: String)(json: => String): View = View(topic, () => json.getBytes(UTF_8))

  private val FixedFrames                = "/tf_static"
  private val Frames                     = "/tf"
  private val Log                        = "/log"
  private def bodyOf(name: String)       = s"/vehicles/$name/body"
  private def poseOf(name: String)       = s"/vehicles/$name/pose"
  private def trailOf(name: String)      = s"/vehicles/$name/trail"
  private def predictionOf(name: String) = s"/vehicles/$name/prediction"
  private def planOf(name: String)       = s"/vehicles/$name/plan"
  private val Standing                   = "/scene"

  private val Car         = VehicleKind.Car.toString
  private val MultirotorM = Vector3(0.8, 0.8, 0.25)

  /** Size of a BMW 320i, as the built-in simulator's cars. */
  private val CarM = Vector3(4.508, 1.61, 1.42)

  def imageOf(sensor: ImagingSensor): String       = s"/vehicles/${sensor.vehicle}/${sensor.name}/image"
  def calibrationOf(sensor: ImagingSensor): String = s"/vehicles/${sensor.vehicle}/${sensor.name}/calibration"
  def cloudOf(sensor: ImagingSensor): String       = s"/vehicles/${sensor.vehicle}/${sensor.name}/cloud"

  /** Every topic with the name of its schema. */
  def topics(vehicles: Vector[String]): Vector[(String, String)] =
    Vector(FixedFrames, Frames).map(_ -> "foxglove.FrameTransforms") ++
      vehicles.map(poseOf(_) -> "foxglove.PoseInFrame") ++
      vehicles.flatMap(name => Vector(bodyOf(name), trailOf(name), predictionOf(name), planOf(name))).map(
        _ -> "foxglove.SceneUpdate"
      ) ++ Vector(Standing -> "foxglove.SceneUpdate", Log -> "foxglove.Log")

  private final class Trail(var shownAt: Instant):
    val points: mutable.ArrayBuffer[(Instant, Vector3)] = mutable.ArrayBuffer.empty

  private val Warning     = "3"
  private val LineStrip   = "0"
  private val TrailEvery  = Span.ofSeconds(1)
  private val TrailLength = Span.ofSeconds(20)

  /** Half a turn about the line between north and east: swaps x and y, and negates z. */
  private val NedInWorld = Quaternion(0, math.sqrt(0.5), math.sqrt(0.5), 0)

  /** Rotation of a camera's optical frame, right, down, front, in its own, front, right, down. */
  private val OpticalInCamera = Quaternion(0.5, 0.5, 0.5, 0.5)

  /** Thickness of the plates with tags. */
  private val TagM = 0.002

  private val Doubt = Json.obj("r" -> "0.5", "g" -> "0.5", "b" -> "0.5", "a" -> "0.3")

  /** Product of two rotations, the right one first. */
  private def times(a: Quaternion, b: Quaternion) = Quaternion(
    a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
    a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
    a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w
  )

  /** @param rgb 0xrrggbb
    */
  private def painted(rgb: Int) =
    def part(shift: Int) = Json.number((rgb >> shift & 0xff) / 255.0)
    Json.obj("r" -> part(16), "g" -> part(8), "b" -> part(0), "a" -> "1")

  private def colour(at: Int) =
    val (r, g, b) =
      Vector((0.9, 0.3, 0.2), (0.2, 0.5, 0.9), (0.2, 0.7, 0.3), (0.8, 0.6, 0.1), (0.6, 0.3, 0.8))(at % 5)
    Json.obj("r" -> s"$r", "g" -> s"$g", "b" -> s"$b", "a" -> "1")

  private def time(at: Instant) = seconds(at.toNanos.max(0))
  private def seconds(ns: Long) =
    Json.obj("sec" -> s"${ns / 1_000_000_000L}", "nsec" -> s"${ns % 1_000_000_000L}")

  private def xyz(v: Vector3) =
    Json.obj("x" -> Json.number(v.x), "y" -> Json.number(v.y), "z" -> Json.number(v.z))

  private def wxyz(q: Quaternion) = Json.obj(
    "x" -> Json.number(q.x),
    "y" -> Json.number(q.y),
    "z" -> Json.number(q.z),
    "w" -> Json.number(q.w)
  )

  private def placed(position: Vector3, orientation: Quaternion) =
    Json.obj("position" -> xyz(position), "orientation" -> wxyz(orientation))

  private def pose(at: Instant, position: Vector3, orientation: Quaternion) = Json.obj(
    "timestamp" -> time(at),
    "frame_id"  -> "\"world_ned\"",
    "pose"      -> placed(position, orientation)
  )

  private def transform(
      topic: String,
      at: Instant,
      parent: String,
      child: String,
      position: Vector3,
      orientation: Quaternion
  ) = View.text(topic):
    val one = Json.obj(
      "timestamp"       -> time(at),
      "parent_frame_id" -> Json.string(parent),
      "child_frame_id"  -> Json.string(child),
      "translation"     -> xyz(position),
      "rotation"        -> wxyz(orientation)
    )
    Json.obj("transforms" -> Json.array(Vector(one)))

  /** One entity, whose parts are drawn when somebody looks. */
  private def scene(
      topic: String,
      at: Instant,
      id: String,
      frame: String = "world_ned",
      cubes: => Vector[String] = Vector.empty,
      spheres: => Vector[String] = Vector.empty,
      cylinders: => Vector[String] = Vector.empty,
      lines: => Vector[String] = Vector.empty,
      texts: => Vector[String] = Vector.empty
  ) = View.text(topic):
    val entity = Json.obj(
      "timestamp"    -> time(at),
      "frame_id"     -> Json.string(frame),
      "id"           -> Json.string(id),
      "lifetime"     -> seconds(0),
      "frame_locked" -> "true",
      "metadata"     -> "[]",
      "arrows"       -> "[]",
      "cubes"        -> Json.array(cubes),
      "spheres"      -> Json.array(spheres),
      "cylinders"    -> Json.array(cylinders),
      "lines"        -> Json.array(lines),
      "triangles"    -> "[]",
      "texts"        -> Json.array(texts),
      "models"       -> "[]"
    )
    Json.obj("deletions" -> "[]", "entities" -> Json.array(Vector(entity)))
