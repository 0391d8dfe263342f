package skein.record

import java.util.Base64
import scala.util.Using

/** The Foxglove schemas that views of a flight use, as JSON Schema, with the fields that are written
  * (https://docs.foxglove.dev/docs/sdk/schemas).
  */
private[record] object FoxgloveSchemas:

  /** Foxglove's schemas of binary messages, as `FileDescriptorSet` in Base64, keyed by name; under the MIT
    * licence.
    */
  val binary: Map[String, String] = Vector("RawImage", "CompressedImage", "PointCloud").map: name =>
    val set = Using.resource(getClass.getResourceAsStream(s"foxglove/$name.fds"))(_.readAllBytes())
    s"foxglove.$name" -> Base64.getEncoder.encodeToString(set)
  .toMap

  private def typed(kind: String) = Json.obj("type" -> Json.string(kind))
  private val number              = typed("number")
  private val integer             = typed("integer")
  private val text                = typed("string")
  // Viewers read every object's properties, even if there are none.
  private val nobody                         = Json.obj("type" -> "\"object\"", "properties" -> "{}")
  private def many(items: String)            = Json.obj("type" -> "\"array\"", "items" -> items)
  private def fields(all: (String, String)*) =
    Json.obj("type" -> "\"object\"", "properties" -> Json.obj(all*))
  private def titled(name: String, all: (String, String)*) =
    Json.obj("title" -> Json.string(name), "type" -> "\"object\"", "properties" -> Json.obj(all*))

  private val time       = fields("sec" -> integer, "nsec" -> integer)
  private val vector     = fields("x" -> number, "y" -> number, "z" -> number)
  private val quaternion = fields("x" -> number, "y" -> number, "z" -> number, "w" -> number)
  private val pose       = fields("position" -> vector, "orientation" -> quaternion)
  private val colour     = fields("r" -> number, "g" -> number, "b" -> number, "a" -> number)

  val all: Map[String, String] = Map(
    "foxglove.PoseInFrame" ->
      titled("foxglove.PoseInFrame", "timestamp" -> time, "frame_id" -> text, "pose" -> pose),
    "foxglove.FrameTransforms" -> titled(
      "foxglove.FrameTransforms",
      "transforms" -> many(
        fields(
          "timestamp"       -> time,
          "parent_frame_id" -> text,
          "child_frame_id"  -> text,
          "translation"     -> vector,
          "rotation"        -> quaternion
        )
      )
    ),
    "foxglove.CameraCalibration" -> titled(
      "foxglove.CameraCalibration",
      "timestamp"        -> time,
      "frame_id"         -> text,
      "width"            -> integer,
      "height"           -> integer,
      "distortion_model" -> text,
      "D"                -> many(number),
      "K"                -> many(number),
      "R"                -> many(number),
      "P"                -> many(number)
    ),
    "foxglove.Log" -> titled(
      "foxglove.Log",
      "timestamp" -> time,
      "level"     -> integer,
      "message"   -> text,
      "name"      -> text,
      "file"      -> text,
      "line"      -> integer
    ),
    "foxglove.SceneUpdate" -> titled(
      "foxglove.SceneUpdate",
      "deletions" -> many(nobody),
      "entities"  -> many(
        fields(
          "timestamp"    -> time,
          "frame_id"     -> text,
          "id"           -> text,
          "lifetime"     -> time,
          "frame_locked" -> typed("boolean"),
          "metadata"     -> many(nobody),
          "arrows"       -> many(nobody),
          "cubes"        -> many(fields("pose" -> pose, "size" -> vector, "color" -> colour)),
          "spheres"      -> many(fields("pose" -> pose, "size" -> vector, "color" -> colour)),
          "cylinders"    -> many(
            fields(
              "pose"         -> pose,
              "size"         -> vector,
              "bottom_scale" -> number,
              "top_scale"    -> number,
              "color"        -> colour
            )
          ),
          "lines" -> many(
            fields(
              "type"            -> integer,
              "pose"            -> pose,
              "thickness"       -> number,
              "scale_invariant" -> typed("boolean"),
              "points"          -> many(vector),
              "color"           -> colour,
              "colors"          -> many(colour),
              "indices"         -> many(integer)
            )
          ),
          "triangles" -> many(nobody),
          "texts"     -> many(
            fields(
              "pose"            -> pose,
              "billboard"       -> typed("boolean"),
              "font_size"       -> number,
              "scale_invariant" -> typed("boolean"),
              "color"           -> colour,
              "text"            -> text
            )
          ),
          "models" -> many(nobody)
        )
      )
    )
  )
