package skein.recognition

import java.nio.file.{Files, Path}
import scala.util.Try
import skein.policy.*
import skein.scenario.*
import skein.signal.LatencyProfile
import skein.units.*

/** The paper's duel, but the pursuer observes the evader only through its camera.
  *
  * @param blind whether it observes only through the camera; if false, its policy receives the evader's true
  *   position
  * @param recogniser the recogniser: `tags` finds AprilTags on the evader's sides; `detector`: the evader has
  *   no tags, and the detector that comes with this library looks for it; or the file of another ONNX
  *   detector, as [[VehicleDetector.load]] reads it
  * @param takes duration of recognition: a latency profile, such as `uniform:15ms..120ms`, or `file:PATH`
  *   with measured times
  * @param everyMs period of the images
  * @param widthPx width of an image
  * @param heightPx height of an image
  * @param fovDeg horizontal field of view
  * @param altitudeM altitude of both vehicles
  */
final case class BlindPursuit(
    blind: Boolean = true,
    recogniser: String = "tags",
    takes: String = "uniform:15ms..120ms",
    everyMs: Int = 100,
    widthPx: Int = 800,
    heightPx: Int = 600,
    fovDeg: Double = 100,
    altitudeM: Double = PaperDuel.AltitudeM
) extends Scenario:

  override def mistakes: Seq[String] =
    Scenario.outside("everyMs", everyMs, 20, 1000).toSeq ++
      Scenario.outside("widthPx", widthPx, 64, 4096) ++ Scenario.outside("heightPx", heightPx, 64, 4096) ++
      Scenario.notPositive(this) ++ Option.when(fovDeg >= 180)(s"fovDeg: expected below 180, got $fovDeg") ++
      recognition.left.toOption.map(mistake => s"takes: $mistake") ++
      recognisers.left.toOption.map(mistake => s"recogniser: $mistake")

  def agents: Vector[Agent] =
    val Vector(evader, pursuer) = PaperDuel(altitudeM = altitudeM).agents: @unchecked
    val sensor                  = Option.when(blind)(BlindPursuit.Sensor)
    Vector(
      evader,
      pursuer.copy(policy = CameraPursuer(PaperPursuer(), sensor, evader.startPositionNed))
    )

  override def scene: String = if recogniser == BlindPursuit.Tags then "pursuit" else "empty"

  override def equipment: Vector[Equipment] =
    Vector(Equipment.Camera("Pursuer", BlindPursuit.Camera, widthPx, heightPx, fovDeg))

  override def eyes: Vector[Eye] =
    for
      takes <- recognition.toOption.toVector if blind
      made  <- recognisers.toOption
    yield Eye(
      "Pursuer",
      BlindPursuit.Sensor,
      BlindPursuit.Camera,
      target = "Evader",
      Span.ofMillis(everyMs),
      made,
      takes
    )

  override def series: Vector[Series] = Vector(distance)

  override def measures: Vector[Measure] = Vector(
    distance.mean("last 10 s", Window.Last(10)),
    distance.least("closest"),
    distance.leastAt("at")
  )

  override def note: String = "Horizontal distance between pursuer and evader" +
    (if blind then ", of whom the pursuer knows by its camera alone." else ", of whom the pursuer is told.")

  private def distance = Series("distance", "m")(tracks => tracks.distanceM(1, 0, _))

  private def camera = Pinhole(widthPx, heightPx, Radians(StrictMath.toRadians(fovDeg)))

  private def recognisers: Either[String, () => Recogniser] = recogniser match
    // The evader is the first vehicle, and so bears the first tag.
    case BlindPursuit.Tags     => Right(() => VehicleTags(camera, id = 0, BlindPursuit.TagSide))
    case BlindPursuit.Detector => VehicleDetector.shipped(camera).map(detector => () => detector)
    case file                  =>
      VehicleDetector
        .load(camera, Path.of(file))
        .map(detector => () => detector)
        .left
        .map(mistake => s"expected tags, detector or an ONNX file: $mistake")

  private def recognition: Either[String, LatencyProfile] =
    LatencyProfile
      .parse(takes, path => Try(Files.readString(Path.of(path))).toEither.left.map(_.toString))
      .left
      .map(_.message)

object BlindPursuit:
  /** Side of the tags on vehicles in the scene `pursuit`. */
  val TagSide: Metres = Metres(1)

  private val Tags     = "tags"
  private val Detector = "detector"

  private val Sensor = "evader"
  private val Camera = "front_center"
