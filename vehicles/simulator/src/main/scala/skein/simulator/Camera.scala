package skein.simulator

import skein.airsim.wire.{CameraInfo, Pose, ProjectionMatrix}
import skein.units.{Quaternion, Vector3}

/** A vehicle's camera: its mount, lens and film.
  *
  * @param position mounting position on the vehicle, front right down, m
  * @param orientation relative to the vehicle
  * @param distortion K1, K2, K3, P1, P2 of the Brown-Conrady model
  * @param isZoomed whether a client has set its field of view, lens or film: then it holds for all image
  *   types
  */
final private[simulator] case class Camera(
    position: Vector3,
    orientation: Quaternion,
    lens: Lens = Lens.Universal,
    filmback: Filmback = Filmback.DigitalFilm,
    focalLengthMm: Float = Filmback.DigitalFilm.focalLengthMm(Camera.DefaultFovDeg),
    apertureF: Float = 2.8f,
    focusDistanceCm: Float = 100_000f,
    distortion: Vector[Float] = Vector.fill(Camera.DistortionNames.size)(0f),
    isZoomed: Boolean = false
):
  /** Horizontal field of view, degrees, from film and focal length. */
  def fovDeg: Float = filmback.fovDeg(focalLengthMm)

  def verticalFovDeg: Float =
    math.toDegrees(2 * StrictMath.atan(filmback.heightMm / (2.0 * focalLengthMm))).toFloat

  /** A camera with this horizontal field of view: sets the focal length, as Unreal's cine camera does. */
  def withFov(degrees: Float): Camera =
    copy(focalLengthMm = filmback.focalLengthMm(degrees), isZoomed = true)

  /** A camera with this focal length, clamped to the lens's range. */
  def withFocalLength(mm: Float): Camera =
    copy(focalLengthMm = mm.max(lens.shortestMm).min(lens.longestMm), isZoomed = true)

  def withFilm(filmback: Filmback): Camera = copy(filmback = filmback, isZoomed = true)

  def withLens(lens: Lens): Camera = copy(lens = lens).withFocalLength(focalLengthMm)

  def withDistortion(index: Int, value: Float): Camera = copy(distortion = distortion.updated(index, value))

  /** AirSim's camera information for a vehicle at this position. */
  def info(vehicle: Vector3, attitude: Quaternion): CameraInfo = CameraInfo(
    Pose(vehicle + attitude.toWorld(position), attitude * orientation),
    fovDeg,
    ProjectionMatrix(projection)
  )

  /** The projection from front, right, down into Unreal's clip space with its inverted depth, near plane 10
    * cm (`APIPCamera::getProjectionMatrix`), for images of the default 256 × 144.
    */
  private def projection: Seq[Seq[Float]] =
    val across = (1 / StrictMath.tan(math.toRadians(fovDeg) / 2)).toFloat
    Seq(
      Seq(0f, across, 0f, 0f),
      Seq(0f, 0f, -across * Camera.AspectRatio, 0f),
      Seq(0f, 0f, 0f, Camera.NearPlaneCm),
      Seq(-1f, 0f, 0f, 0f)
    )

private[simulator] object Camera:
  val DefaultFovDeg   = 90f
  val DistortionNames = Vector("K1", "K2", "K3", "P1", "P2")

  private val AspectRatio = 256f / 144
  private val NearPlaneCm = 10f

/** A lens of Unreal's cine camera: focal lengths in mm, f-stops. */
final private[simulator] case class Lens(
    name: String,
    shortestMm: Float,
    longestMm: Float,
    widestF: Float,
    narrowestF: Float
):
  /** A description in AirSim's text format. */
  def text: String =
    s"Name: $name;\n\t MinFocalLength: ${Lens.plain(shortestMm)}; \t " +
      s"MaxFocalLength: ${Lens.plain(longestMm)}\n\t Min FStop: " +
      s"${Lens.plain(widestF)}; \t Max Fstop: ${Lens.plain(narrowestF)}"

private[simulator] object Lens:
  val Universal: Lens = Lens("Universal Zoom", 4, 1000, 1.2f, 22)

  /** The lens presets of Unreal's cine camera. */
  val Presets: Seq[Lens] = Seq(
    Lens("12mm Prime f/2.8", 12, 12, 2.8f, 22),
    Lens("30mm Prime f/1.4", 30, 30, 1.4f, 22),
    Lens("50mm Prime f/1.8", 50, 50, 1.8f, 22),
    Lens("85mm Prime f/1.8", 85, 85, 1.8f, 22),
    Lens("105mm Prime f/2", 105, 105, 2, 22),
    Lens("200mm Prime f/2", 200, 200, 2, 22),
    Lens("24-70mm Zoom f/2.8", 24, 70, 2.8f, 22),
    Lens("70-200mm Zoom f/2.8", 70, 200, 2.8f, 22),
    Universal
  )

  /** Formats a number as C++ streams do: without `.0`. */
  def plain(number: Float): String =
    if number == number.toInt.toFloat then number.toInt.toString else number.toString

/** The film format behind the lens, lengths in mm. */
final private[simulator] case class Filmback(name: String, widthMm: Float, heightMm: Float):
  def aspectRatio: Float = widthMm / heightMm

  /** Horizontal field of view of this focal length, degrees. */
  def fovDeg(focalLengthMm: Float): Float =
    math.toDegrees(2 * StrictMath.atan(widthMm / (2.0 * focalLengthMm))).toFloat

  def focalLengthMm(fovDeg: Float): Float =
    (widthMm / (2 * StrictMath.tan(math.toRadians(fovDeg) / 2))).toFloat

  /** A description in AirSim's text format. */
  def text: String =
    s"Name: $name;\n\t Sensor Width: ${Lens.plain(widthMm)}; \t Sensor Height: ${Lens.plain(heightMm)}" +
      s"\n\t Sensor Aspect Ratio: ${Lens.plain(aspectRatio)}"

private[simulator] object Filmback:
  val DigitalFilm: Filmback = Filmback("16:9 Digital Film", 23.76f, 13.365f)

  /** The film presets of Unreal's cine camera. */
  val Presets: Seq[Filmback] = Seq(
    Filmback("16:9 Film", 24, 13.5f),
    DigitalFilm,
    Filmback("16:9 DSLR", 36, 20.25f),
    Filmback("Super 8mm", 5.79f, 4.01f),
    Filmback("Super 16mm", 12.52f, 7.58f),
    Filmback("Super 35mm", 24.89f, 18.66f),
    Filmback("35mm Academy", 21.946f, 16.002f),
    Filmback("35mm VistaVision", 37.719f, 25.146f),
    Filmback("IMAX 70mm", 70.41f, 56.63f),
    Filmback("APS-C (Canon)", 22.2f, 14.8f),
    Filmback("Full Frame DSLR", 36, 24),
    Filmback("Micro Four Thirds", 17.3f, 13)
  )
