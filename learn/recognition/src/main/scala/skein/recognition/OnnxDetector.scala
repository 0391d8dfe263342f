package skein.recognition

import java.nio.ByteBuffer
import skein.airsim.{Image, Pixels}

/** An object detected in an image: its bounding box, in the image's pixels.
  *
  * @param kind the number of the object's class, in the model's order
  * @param score the detector's confidence, from 0 to 1
  */
final case class Box(left: Double, top: Double, right: Double, bottom: Double, kind: Int, score: Double):
  def width: Double  = right - left
  def height: Double = bottom - top

  /** Area of the intersection over that of the union, from 0 to 1. */
  def overlap(other: Box): Double =
    val across = (math.min(right, other.right) - math.max(left, other.left)).max(0)
    val down   = (math.min(bottom, other.bottom) - math.max(top, other.top)).max(0)
    val both   = across * down
    if both == 0 then 0 else both / (width * height + other.width * other.height - both)

/** The layout of boxes in a detector's output, in pixels of its input. */
enum BoxForm:
  /** 1 × (4 + kinds) × boxes: each column is a box's middle, width and height, then a score of each kind:
    * YOLOv8 and its successors. One object may have several boxes.
    */
  case Columns

  /** 1 × boxes × 6: each row is left, top, right, bottom, score, kind: models that suppress overlaps
    * themselves.
    */
  case Rows

/** Any object detector in ONNX form, by onnxruntime. Thread-safe.
  *
  * @param form the model's input
  * @param boxes the layout of its output
  * @param leastScore minimum score of a detection
  * @param mostOverlap maximum overlap of two boxes of one kind; of boxes that overlap more, the one with the
  *   higher score counts
  */
final class OnnxDetector(
    model: OnnxModel,
    form: InputForm,
    boxes: BoxForm = BoxForm.Columns,
    leastScore: Double = 0.5,
    mostOverlap: Double = 0.45
):
  /** The objects in an image, the highest score first; Left says why it cannot be searched. */
  def find(image: Image): Either[String, Vector[Box]] = image.pixels match
    case Pixels.Bgr(bytes) => find(image.width, image.height, bytes.buffer)
    case other             => Left(s"expected raw pixels, got ${other.productPrefix}")

  /** @param bgr blue, green, red of each pixel, in rows from the top
    */
  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Vector[Box]] =
    for
      tensor  <- form.tensor(width, height, bgr)
      outputs <- model.run(tensor, Vector(1, 3, form.height, form.width))
      found   <- OnnxDetector.read(outputs.values.head, boxes, leastScore)
    yield
      val (x, y) = (width.toDouble / form.width, height.toDouble / form.height)
      OnnxDetector
        .distinct(found, mostOverlap)
        .map(box =>
          box.copy(left = box.left * x, top = box.top * y, right = box.right * x, bottom = box.bottom * y)
        )

object OnnxDetector:
  /** The boxes of an output, in pixels of the model's input. */
  private[recognition] def read(
      output: OnnxModel.Output,
      form: BoxForm,
      leastScore: Double
  ): Either[String, Vector[Box]] = (form, output.shape) match
    case (BoxForm.Columns, Vector(1, rows, count)) if rows > 4 =>
      def at(row: Int, box: Int) = output.values(row * count + box).toDouble
      Right((0 until count).iterator
        .map: box =>
          val kind                  = (4 until rows).maxBy(at(_, box))
          val (x, y, width, height) = (at(0, box), at(1, box), at(2, box), at(3, box))
          Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2, kind - 4, at(kind, box))
        .filter(_.score >= leastScore)
        .toVector)
    case (BoxForm.Rows, Vector(1, count, 6)) =>
      Right(Vector
        .tabulate(count): box =>
          val told = output.values.slice(6 * box, 6 * box + 6).map(_.toDouble)
          Box(told(0), told(1), told(2), told(3), told(5).toInt, told(4))
        .filter(_.score >= leastScore))
    case (_, shape) =>
      val expected = form match
        case BoxForm.Columns => "1 × (4 + kinds) × boxes"
        case BoxForm.Rows    => "1 × boxes × 6"
      Left(s"expected an output of $expected, got ${shape.mkString(" × ")}")

  /** One box for each object, the highest score first (greedy non-maximum suppression). */
  private[recognition] def distinct(found: Vector[Box], mostOverlap: Double): Vector[Box] =
    found
      .sortBy(-_.score)
      .foldLeft(Vector.empty[Box]): (kept, box) =>
        if kept.exists(other => other.kind == box.kind && other.overlap(box) > mostOverlap) then kept
        else kept :+ box
