package skein.simulator

import skein.airsim.ImageKind
import skein.airsim.wire.*
import skein.scene.render.{Kind, Raster, PngEncoder, Renderer, View}
import skein.scene.{Moment, Placement}

/** Images requested together. All show one instant, and images of one camera and size are from one pass. They
  * are drawn once, on any thread.
  */
final private[simulator] class Shots private (
    moment: Moment,
    vehicle: Int,
    ids: Vector[Int],
    wanted: Seq[Shots.Wanted]
):
  import Shots.*

  def take(): Seq[ImageResponse] =
    val drawn = wanted.groupBy(_.view).map: (view, shots) =>
      view -> Renderer.draw(moment, view, shots.map(_.kind).toSet, ids(_), except = moment.itemOf(vehicle))
    wanted.map(shot => response(shot, drawn(shot.view)(shot.kind)))

  private def response(shot: Wanted, image: Raster): ImageResponse =
    val view  = shot.view
    val empty = shot.response.copy(width = view.width, height = view.height)
    if shot.response.pixels_as_float then empty.copy(image_data_float = numbers(image))
    else if shot.response.compress then
      empty.copy(image_data_uint8 = PngEncoder.encode(bytes(image), view.width, view.height))
    else empty.copy(image_data_uint8 = bytes(image))

  /** Converts a coloured image to numbers: its red from 0 to 1, as in AirSim. */
  private def numbers(image: Raster): Array[Float] = image match
    case Raster.Numbers(values) => values
    case Raster.Bytes(bgr)      => Array.tabulate(bgr.length / 3)(i => (bgr(3 * i + 2) & 0xff) / 255f)

  /** Converts an image of numbers to grey that is white from 1 on, as in AirSim. */
  private def bytes(image: Raster): Array[Byte] = image match
    case Raster.Bytes(bgr)      => bgr
    case Raster.Numbers(values) => values.flatMap: value =>
        val grey = (math.min(1f, value) * 255 + 0.5f).toByte
        Array(grey, grey, grey)

private[simulator] object Shots:
  /** @param response the response's fields that are known before drawing */
  final case class Wanted(view: View, kind: Kind, response: ImageResponse)

  val MostImages = 64

  /** Maximum size of one answer in bytes, which Skein's own client accepts. */
  val MostBytes: Long = 60L << 20

  def noCamera(name: String): String = s"No camera with name $name exist on vehicle"

  /** AirSim's image type of this number. */
  def typeOf(imageType: Int): Either[String, ImageKind] =
    if ImageKind.values.indices.contains(imageType) then Right(ImageKind.fromOrdinal(imageType))
    else Left(s"an image type is 0 to ${ImageKind.values.length - 1}, not $imageType")

  /** The kind that is drawn for AirSim's number of an image type. */
  def kindOf(imageType: Int): Either[String, Kind] = typeOf(imageType).flatMap:
    case flow @ (ImageKind.OpticalFlow | ImageKind.OpticalFlowVis) =>
      Left(s"the built-in simulator draws no $flow")
    case kind => Right(Kind.fromOrdinal(kind.ordinal))

  /** The current view through a vehicle's camera. */
  def view(simulation: Simulated, vehicle: Int, camera: String, imageType: Int): View =
    val owner   = simulation.world.vehicles(vehicle)
    val seen    = simulation.cameras(vehicle, owner, camera)
    val capture = simulation.equipment.capture(owner.settings.name, camera, imageType)
    val place   = simulation.world.placeOf(vehicle, simulation.world.now)
    View(
      place.outside(Placement(seen.position, seen.orientation)),
      capture.width,
      capture.height,
      fovDeg(if seen.isZoomed then seen else seen.withFov(capture.fovDeg))
    )

  /** The camera's field of view, clamped to the range of an image, because films and lenses can be set to
    * anything.
    */
  private def fovDeg(camera: Camera): Double = math.max(0.01, math.min(179.9, camera.fovDeg.toDouble))

  def of(simulation: Simulated, vehicle: Int, requests: Seq[ImageRequest]): Either[String, Shots] =
    val asked = requests.map(wanted(simulation, vehicle, _))
    val size  = asked.iterator.collect { case Right(shot) => bytesOf(shot) }.sum
    if requests.size > MostImages then
      Left(s"at most $MostImages images are rendered in one call, not ${requests.size}")
    else if size > MostBytes then Left(s"images of $size bytes in one answer; at most $MostBytes are sent")
    else
      asked.collectFirst { case Left(refusal) => refusal }.toLeft:
        Shots(
          simulation.objects.moment,
          vehicle,
          simulation.objects.ids,
          asked.collect { case Right(shot) => shot }
        )

  private def bytesOf(shot: Wanted): Long =
    shot.view.width.toLong * shot.view.height * (if shot.response.pixels_as_float then 5 else 3)

  private def wanted(simulation: Simulated, vehicle: Int, request: ImageRequest): Either[String, Wanted] =
    val owner = simulation.world.vehicles(vehicle)
    for
      kind <- kindOf(request.image_type)
      name <-
        simulation.cameras.canonical(owner, request.camera_name).toRight(noCamera(request.camera_name))
    yield
      val seen = view(simulation, vehicle, name, request.image_type)
      Wanted(
        seen,
        kind,
        ImageResponse(
          camera_position = Vector3r(seen.place.position - owner.settings.startNed),
          camera_name = request.camera_name,
          camera_orientation = Quaternionr(seen.place.orientation),
          time_stamp = simulation.world.now,
          pixels_as_float = request.pixels_as_float,
          compress = request.compress,
          image_type = request.image_type
        )
      )
