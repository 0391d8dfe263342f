package skein.record

import scala.collection.mutable
import skein.units.*

/** What viewers show of a flight, as messages of Foxglove's schemas, made from the rows in their order. Frames: `world` is
  * east, north, up, as viewers draw; `world_ned` north, east, down, as all else of a flight; each vehicle's own is its
  * body, front, right, down. Times in messages are when physics was sampled, on the controller's clock, as far as the
  * offset of the simulator's was known by then.
  */
private[record] final class FoxgloveViews(vehicles: Vector[String], firstOffset: Option[Span]):
  import FoxgloveViews.*

  private val colours = vehicles.zipWithIndex.map((name, at) => name -> colour(at)).toMap
  private var offset  = firstOffset
  private val trails  = mutable.Map.empty[String, Trail]

  /** Before the first row. */
  def opening(at: Instant): Vector[View] =
    def world = transform(at, "world", "world_ned", Vector3(0, 0, 0), NedInWorld)
    View(FixedFrames, () => Json.obj("transforms" -> Json.array(Vector(world)))) +: vehicles.map: name =>
      def drawn = entity(at, name, name, cubes = Vector(body(name)), texts = Vector(label(name)))
      View(bodyOf(name), () => scene(drawn))

  def of(record: Record): Vector[View] = record match
    case reading: Reading =>
      // As long as nothing better is known, as if the first reading had taken no time.
      val ahead = offset.getOrElse(reading.state.receivedAt.since(reading.state.validAt))
      offset = Some(ahead)
      val at     = reading.state.validAt + ahead
      val state  = reading.state.value
      val name   = reading.vehicle
      def moved  = transform(at, "world_ned", name, state.positionNed, state.orientation)
      def placed = pose(at, state.positionNed, state.orientation)
      Vector(
        View(Frames, () => Json.obj("transforms" -> Json.array(Vector(moved)))),
        View(poseOf(name), () => placed)
      ) ++ trail(name, at, state.positionNed)
    case decision: Decision =>
      decision.trueAge.foreach(age => offset = Some(age.clockOffset))
      val name = decision.vehicle
      decision.predicted.toVector.map: expected =>
        val at   = expected.actsAt + offset.getOrElse(Span.Zero)
        val from = decision.own.state.value.positionNed
        View(predictionOf(name), () => scene(carried(name, at, from, expected.ownPositionNed)))
    case event: Event =>
      def log = Json.obj(
        "timestamp" -> time(event.at),
        "level"     -> Warning,
        "message"   -> Json.string(s"${event.kind}: ${event.detail}"),
        "name"      -> Json.string(event.vehicle.getOrElse("flight")),
        "file"      -> "\"\"",
        "line"      -> "0"
      )
      Vector(View(Log, () => log))
    case _ => Vector.empty

  /** Where the vehicle has flown lately: as a whole, once a second, so that whoever jumps to a time sees it at once. */
  private def trail(name: String, at: Instant, position: Vector3): Option[View] =
    val trail = trails.getOrElseUpdate(name, Trail(at))
    trail.points.append((at, position)): Unit
    Option.when(at.since(trail.shownAt) >= TrailEvery):
      trail.shownAt = at
      trail.points.dropWhileInPlace((passed, _) => at.since(passed) > TrailLength): Unit
      val points = trail.points.toVector.map(_._2)
      def drawn  = entity(at, "world_ned", s"$name trail", lines = Vector(line(name, points, thickness = 2)))
      View(trailOf(name), () => scene(drawn))

  /** From where a vehicle was read to where it is expected when the command acts. */
  private def carried(name: String, at: Instant, from: Vector3, to: Vector3) =
    val there = Json.obj(
      "pose"  -> placed(to, Quaternion(1, 0, 0, 0)),
      "size"  -> xyz(Vector3(0.5, 0.5, 0.5)),
      "color" -> colours(name)
    )
    val way = line(name, Vector(from, to), thickness = 4)
    entity(at, "world_ned", s"$name prediction", cubes = Vector(there), lines = Vector(way))

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

  private def body(name: String) = Json.obj(
    "pose"  -> placed(Vector3(0, 0, 0), Quaternion(1, 0, 0, 0)),
    "size"  -> xyz(Vector3(0.8, 0.8, 0.25)),
    "color" -> colours(name)
  )

  private def label(name: String) = Json.obj(
    "pose"            -> placed(Vector3(0, 0, -1), Quaternion(1, 0, 0, 0)),
    "billboard"       -> "true",
    "font_size"       -> "14",
    "scale_invariant" -> "true",
    "color"           -> colours(name),
    "text"            -> Json.string(name)
  )

private[record] object FoxgloveViews:
  /** A message for a topic; its JSON is made when it is wanted. */
  final case class View(topic: String, json: () => String)

  private val FixedFrames                = "/tf_static"
  private val Frames                     = "/tf"
  private val Log                        = "/log"
  private def bodyOf(name: String)       = s"/vehicles/$name/body"
  private def poseOf(name: String)       = s"/vehicles/$name/pose"
  private def trailOf(name: String)      = s"/vehicles/$name/trail"
  private def predictionOf(name: String) = s"/vehicles/$name/prediction"

  /** Every topic with the name of its schema. */
  def topics(vehicles: Vector[String]): Vector[(String, String)] =
    Vector(FixedFrames, Frames).map(_ -> "foxglove.FrameTransforms") ++
      vehicles.map(poseOf(_) -> "foxglove.PoseInFrame") ++
      vehicles.flatMap(name => Vector(bodyOf(name), trailOf(name), predictionOf(name))).map(
        _ -> "foxglove.SceneUpdate"
      ) :+ (Log -> "foxglove.Log")

  private final class Trail(var shownAt: Instant):
    val points: mutable.ArrayBuffer[(Instant, Vector3)] = mutable.ArrayBuffer.empty

  private val Warning     = "3"
  private val LineStrip   = "0"
  private val TrailEvery  = Span.ofSeconds(1)
  private val TrailLength = Span.ofSeconds(20)

  /** Half a turn about the line between north and east: x becomes y, y becomes x, and z turns round. */
  private val NedInWorld = Quaternion(0, math.sqrt(0.5), math.sqrt(0.5), 0)

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
      at: Instant,
      parent: String,
      child: String,
      position: Vector3,
      orientation: Quaternion
  ) =
    Json.obj(
      "timestamp"       -> time(at),
      "parent_frame_id" -> Json.string(parent),
      "child_frame_id"  -> Json.string(child),
      "translation"     -> xyz(position),
      "rotation"        -> wxyz(orientation)
    )

  private def scene(entity: String) = Json.obj("deletions" -> "[]", "entities" -> Json.array(Vector(entity)))

  private def entity(
      at: Instant,
      frame: String,
      id: String,
      cubes: Vector[String] = Vector.empty,
      lines: Vector[String] = Vector.empty,
      texts: Vector[String] = Vector.empty
  ) = Json.obj(
    "timestamp"    -> time(at),
    "frame_id"     -> Json.string(frame),
    "id"           -> Json.string(id),
    "lifetime"     -> seconds(0),
    "frame_locked" -> "true",
    "metadata"     -> "[]",
    "arrows"       -> "[]",
    "cubes"        -> Json.array(cubes),
    "spheres"      -> "[]",
    "cylinders"    -> "[]",
    "lines"        -> Json.array(lines),
    "triangles"    -> "[]",
    "texts"        -> Json.array(texts),
    "models"       -> "[]"
  )
