package skein.recognition

import java.nio.ByteBuffer
import java.nio.file.Path
import skein.fusion.PolarMeasurement
import skein.scenario.Recogniser
import skein.units.*

/** Finds a vehicle by its looks: the box of the highest score. Which of several it is, it does not know. The
  * bearing is that of the box's middle; the range follows from the box's width.
  *
  * @param appearance how wide what is looked for appears
  */
final class VehicleDetector(camera: Pinhole, detector: OnnxDetector, appearance: VehicleDetector.Appearance)
    extends Recogniser:

  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Option[PolarMeasurement]] =
    if width == camera.width && height == camera.height then
      detector.find(width, height, bgr).map(_.headOption.map(polar))
    else Left(s"expected ${camera.width} × ${camera.height} pixels, came $width × $height")

  /** What a box says of where its object is. Of something round that is seen askew, the image shows more than
    * its width: a body of width w at azimuth α and depth d covers f·w / (d·cos α) pixels.
    */
  def polar(box: Box): PolarMeasurement =
    val f     = camera.focalPx
    val right = ((box.left + box.right) / 2 - camera.width / 2.0) / f
    val down  = ((box.top + box.bottom) / 2 - camera.height / 2.0) / f
    val depth = f * appearance.width.value / box.width * math.sqrt(1 + right * right)
    val point = Vector3(1, right, down) * depth
    val angle = Radians(StrictMath.hypot(appearance.deviationPx, appearance.middleShare * box.width) / f)
    // What the image's border cuts may be nearer by any share.
    val isCut = box.left < appearance.deviationPx || box.right > camera.width - appearance.deviationPx
    val share =
      if isCut then 1.0 else StrictMath.hypot(appearance.widthShare, appearance.deviationPx / box.width)
    PolarMeasurement.of(
      point,
      (azimuth = angle, elevation = angle, range = Metres(point.norm * share))
    )

object VehicleDetector:
  /** How something looks to a detector.
    *
    * @param width its mean width, over all sides that it may show
    * @param widthShare standard deviation of a box's width over its mean, over all sides
    * @param middleShare standard deviation of a box's middle over its width
    * @param deviationPx standard deviation of a box's middle, and of its width, besides, in the camera's
    *   pixels
    */
  final case class Appearance(width: Metres, widthShare: Double, middleShare: Double, deviationPx: Double)

  object Appearance:
    /** The built-in simulator's quadrotor as the shipped model sees it: `recognition/Test/runMain
      * skein.recognition.measureDetector`.
      */
    val Quadrotor: Appearance = Appearance(Metres(0.6), 0.15, 0.03, 1.5)

  /** With the model that comes with this library, trained on images of the built-in simulator
    * (`examples/onnx-detector`). It looks at every second pixel.
    */
  def shipped(camera: Pinhole): Either[String, VehicleDetector] = model.map(of(camera, _))

  /** With a model of a file, which finds quadrotors and gives boxes as [[BoxForm.Columns]]. */
  def load(camera: Pinhole, file: Path): Either[String, VehicleDetector] =
    OnnxRuntime.present(OnnxModel.load(file)).map(of(camera, _))

  private def of(camera: Pinhole, model: OnnxModel) =
    val form = model.input match
      case Vector(_, _, height, width) if height > 0 && width > 0 => InputForm(width, height)
      case _ => InputForm((camera.width / 2).max(1), (camera.height / 2).max(1))
    VehicleDetector(camera, OnnxDetector(model, form), Appearance.Quadrotor)

  /** One for all: a session answers several threads at once. */
  private[recognition] lazy val model: Either[String, OnnxModel] = OnnxRuntime.present:
    val in = getClass.getResourceAsStream("vehicle-detector.onnx")
    try OnnxModel.read(in.readAllBytes)
    finally in.close()
