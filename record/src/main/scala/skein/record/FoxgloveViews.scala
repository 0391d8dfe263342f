package skein.record

import scala.collection.mutable
import skein.units.*

/** What viewers show of a flight, as messages of Foxglove's schemas, made from the rows in their order. Frames: `world` is
  * east, north, up, as viewers draw; `world_ned` north, east, down, as all else of a flight; each vehicle's own is its
  * body, front, right, down. Times in messages are when physics was sampled, on the controller's clock, as far as the
  * offset of the simulator's was known by then.
  */
private[record] final class FoxgloveViews(vehicles: Vector[String], firstOffset: Span):
  import FoxgloveViews.*

  private val colours = vehicles.zipWithIndex.map((name, at) => name -> colour(at)).toMap
  private var offset  = firstOffset
  private val trails  = mutable.Map.empty[String, Trail]

  /** Before the first row. */
  def opening(at: Instant): Vector[View] =
    val world = Json.obj(
      "transforms" -> Json.array(Vector(transform(at, "world", "world_ned", Vector3(0, 0, 0), NedInWorld)))
    )
    View("/tf_static", "foxglove.FrameTransforms", world) +: vehicles.map: name =>
      val drawn = entity(at, name, name, cubes = Vector(body(name)), texts = Vector(label(name)))
      View(s"/vehicles/$name/body", "foxglove.SceneUpdate", scene(drawn))

  def of(record: Record): Vector[View] = record match
    case reading: Reading =>
      val at    = reading.state.validAt + offset
      val state = reading.state.value
      val name  = reading.vehicle
      val moved = transform(at, "world_ned", name, state.positionNed, state.orientation)
      val pose  = Json.obj(
        "timestamp" -> time(at),
        "frame_id"  -> "\"world_ned\"",
        "pose"      -> placed(state.positionNed, state.orientation)
      )
      Vector(
        View("/tf", "foxglove.FrameTransforms", Json.obj("transforms" -> Json.array(Vector(moved)))),
        View(s"/vehicles/$name/pose", "foxglove.PoseInFrame", pose)
      ) ++ trail(name, at, state.positionNed)
    case decision: Decision =>
      decision.trueAge.foreach(age => offset = age.clockOffset)
      Vector.empty
    case event: Event =>
      val log = Json.obj(
        "timestamp" -> time(event.at),
        "level"     -> Warning,
        "message"   -> Json.string(s"${event.kind}: ${event.detail}"),
        "name"      -> Json.string(event.vehicle.getOrElse("flight")),
        "file"      -> "\"\"",
        "line"      -> "0"
      )
      Vector(View("/log", "foxglove.Log", log))
    case _ => Vector.empty

  /** Where the vehicle has flown lately: as a whole, once a second, so that whoever jumps to a time sees it at once. */
  private def trail(name: String, at: Instant, position: Vector3): Option[View] =
    val trail = trails.getOrElseUpdate(name, Trail(at))
    trail.points.append((at, position)): Unit
    Option.when(at.since(trail.shownAt) >= TrailEvery):
      trail.shownAt = at
      trail.points.dropWhileInPlace((passed, _) => at.since(passed) > TrailLength): Unit
      val line = Json.obj(
        "type"            -> LineStrip,
        "pose"            -> placed(Vector3(0, 0, 0), Quaternion(1, 0, 0, 0)),
        "thickness"       -> "2",
        "scale_invariant" -> "true",
        "points"          -> Json.array(trail.points.map((_, point) => xyz(point))),
        "color"           -> colours.getOrElse(name, colour(0)),
        "colors"          -> "[]",
        "indices"         -> "[]"
      )
      val drawn = entity(at, "world_ned", s"$name trail", lines = Vector(line))
      View(s"/vehicles/$name/trail", "foxglove.SceneUpdate", scene(drawn))

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
  /** A message for a topic. */
  final case class View(topic: String, schema: String, json: String)

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
