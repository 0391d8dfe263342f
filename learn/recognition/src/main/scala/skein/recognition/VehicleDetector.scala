package skein.recognition

import java.nio.ByteBuffer
import java.nio.file.Path
import skein.fusion.PolarMeasurement
import skein.scenario.Recogniser
import skein.units.*

/** Detects a vehicle by its appearance: the box with the highest score; it cannot distinguish several
  * vehicles. The bearing is that of the box's middle; the range follows from the box's width.
  *
  * @param appearance apparent width of the vehicle
  */
final class VehicleDetector(camera: Pinhole, detector: OnnxDetector, appearance: VehicleDetector.Appearance)
    extends Recogniser:

  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Option[PolarMeasurement]] =
    if width == camera.width && height == camera.height then
      detector.find(width, height, bgr).map(_.headOption.map(polar))
    else Left(s"expected ${camera.width} × ${camera.height} pixels, got $width × $height")

  /** The bearing and range of a box's object. A round object away from the image's middle appears wider: a
    * body of width w at azimuth α and depth d covers f·w / (d·cos α) pixels.
    */
  def polar(box: Box): PolarMeasurement =
    val f     = camera.focalPx
    val right = ((box.left + box.right) / 2 - camera.width / 2.0) / f
    val down  = ((box.top + box.bottom) / 2 - camera.height / 2.0) / f
    val depth = f * appearance.width.value / box.width * math.sqrt(1 + right * right)
    val point = Vector3(1, right, down) * depth
    val angle = Radians(StrictMath.hypot(appearance.deviationPx, appearance.middleShare * box.width) / f)
    // An object cut by the image's border may be nearer by any factor.
    val isCut = box.left < appearance.deviationPx || box.right > camera.width - appearance.deviationPx
    val share =
      if isCut then 1.0 else StrictMath.hypot(appearance.widthShare, appearance.deviationPx / box.width)
    PolarMeasurement.of(
      point,
      (azimuth = angle, elevation = angle, range = Metres(point.norm * share))
    )

object VehicleDetector:
  /** An object's appearance to a detector.
    *
    * @param width its mean width, over all sides that may be visible
    * @param widthShare standard deviation of a box's width over its mean, over all sides
    * @param middleShare standard deviation of a box's middle over its width
    * @param deviationPx additional standard deviation of a box's middle, and of its width, in the camera's
    *   pixels
    */
  final case class Appearance(width: Metres, widthShare: Double, middleShare: Double, deviationPx: Double)

  object Appearance:
    /** The built-in simulator's quadrotor as the shipped model detects it: `recognition/Test/runMain
      * skein.recognition.measureDetector`.
      */
    val Quadrotor: Appearance = Appearance(Metres(0.6), 0.15, 0.03, 1.5)

  /** A detector with the model in this library, trained on images of the built-in simulator
    * (`examples/onnx-detector`). It uses every second pixel.
    */
  def shipped(camera: Pinhole): Either[String, VehicleDetector] = model.map(of(camera, _))

  /** A detector with a model of a file, which detects quadrotors and outputs boxes as [[BoxForm.Columns]]. */
  def load(camera: Pinhole, file: Path): Either[String, VehicleDetector] =
    OnnxRuntime.present(OnnxModel.load(file)).map(of(camera, _))

  private def of(camera: Pinhole, model: OnnxModel) =
    val form = model.input match
      case Vector(_, _, height, width) if height > 0 && width > 0 => InputForm(width, height)
      case _ => InputForm((camera.width / 2).max(1), (camera.height / 2).max(1))
    VehicleDetector(camera, OnnxDetector(model, form), Appearance.Quadrotor)

  /** One shared model: its session is thread-safe. */
  private[recognition] lazy val model: Either[String, OnnxModel] = OnnxRuntime.present:
    val in = getClass.getResourceAsStream("vehicle-detector.onnx")
    try OnnxModel.read(in.readAllBytes)
    finally in.close()
