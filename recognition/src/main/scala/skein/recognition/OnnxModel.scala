package skein.recognition

import ai.onnxruntime.{OnnxTensor, OrtEnvironment, OrtException, OrtSession}
import java.nio.FloatBuffer
import java.nio.file.Path
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.airsim.{Image, Pixels}

/** What a model gave, by the names of its outputs: numbers, row by row, and their shape. */
type Outputs = Map[String, OnnxModel.Output]

/** Any model in ONNX form with one input of floats, such as a detector of objects. Any thread, several at once.
  *
  * @param input
  *   shape of its input; −1 where it takes any size
  */
final class OnnxModel private (session: OrtSession, inputName: String, val input: Vector[Int])
    extends AutoCloseable:

  /** Runs the model on a tensor of the given shape. The error says what the model does not take. */
  def run(tensor: Array[Float], shape: Vector[Int]): Either[String, Outputs] =
    if shape.map(_.toLong).product != tensor.length then
      Left(s"expected ${shape.mkString(" × ")} numbers, came ${tensor.length}")
    else
      OnnxModel.attempt:
        Using.resource(
          OnnxTensor.createTensor(
            OnnxModel.environment,
            FloatBuffer.wrap(tensor),
            shape.map(_.toLong).toArray
          )
        ): sent =>
          Using.resource(session.run(java.util.Map.of(inputName, sent))): result =>
            result.iterator.asScala
              .collect:
                case entry if entry.getValue.isInstanceOf[OnnxTensor] =>
                  entry.getKey -> OnnxModel.outputOf(entry.getValue.asInstanceOf[OnnxTensor])
              .toMap

  /** Runs it on an image, brought into the form that the model was trained on. */
  def run(image: Image, form: InputForm): Either[String, Outputs] =
    form.tensor(image).flatMap(run(_, Vector(1, 3, form.height, form.width)))

  def close(): Unit = session.close()

object OnnxModel:
  /** @param values
    *   row by row; integers are given as floats
    */
  final case class Output(shape: Vector[Int], values: Array[Float])

  private lazy val environment = OrtEnvironment.getEnvironment()

  /** @param threads
    *   that work on one image; several images at once (`Recognise`) need one each
    * @return
    *   or why the file is no such model
    */
  def load(file: Path, threads: Int = 1): Either[String, OnnxModel] =
    if !java.nio.file.Files.isReadable(file) then
      Left(s"$file: expected an ONNX model, there is no such file")
    else of(environment.createSession(file.toString, _), threads).left.map(reason => s"$file: $reason")

  /** The same, from a model's bytes. */
  def read(model: Array[Byte], threads: Int = 1): Either[String, OnnxModel] =
    of(environment.createSession(model, _), threads)

  private def of(create: OrtSession.SessionOptions => OrtSession, threads: Int): Either[String, OnnxModel] =
    attempt:
      Using.resource(OrtSession.SessionOptions()): options =>
        options.setIntraOpNumThreads(threads)
        options.setInterOpNumThreads(1)
        create(options)
    .flatMap: session =>
      val inputs = session.getInputInfo.asScala.toVector.map((name, info) => (name, info.getInfo))
      inputs match
        case Vector((name, tensor: ai.onnxruntime.TensorInfo))
            if tensor.`type` == ai.onnxruntime.OnnxJavaType.FLOAT =>
          Right(OnnxModel(session, name, tensor.getShape.map(_.toInt).toVector))
        case other =>
          session.close()
          Left(
            s"expected a model with one input of floats, came ${other.map((name, info) => s"$name: $info").mkString("; ")}"
          )

  private def outputOf(tensor: OnnxTensor): Output =
    val shape  = tensor.getInfo.getShape.map(_.toInt).toVector
    val floats = Option(tensor.getFloatBuffer)
    val values = floats match
      case Some(buffer) =>
        val all = new Array[Float](buffer.remaining)
        buffer.get(all)
        all
      case None =>
        Option(tensor.getLongBuffer).fold(Array.emptyFloatArray): buffer =>
          Array.fill(buffer.remaining)(buffer.get().toFloat)
    Output(shape, values)

  private def attempt[A](call: => A): Either[String, A] =
    try Right(call)
    catch case error: OrtException => Left(error.getMessage)

/** How an image becomes the tensor 1 × 3 × height × width that a model was trained on: the nearest pixel of each place,
  * (value − mean) · scale of each channel.
  *
  * @param redFirst
  *   whether red is the first channel; else blue is
  * @param mean
  *   of each channel in the model's order, from 0 to 255
  */
final case class InputForm(
    width: Int,
    height: Int,
    redFirst: Boolean = true,
    mean: (Float, Float, Float) = (0, 0, 0),
    scale: (Float, Float, Float) = (1 / 255f, 1 / 255f, 1 / 255f)
):
  require(width > 0 && height > 0, s"a model's picture has pixels: $this")

  def tensor(image: Image): Either[String, Array[Float]] = image.pixels match
    case Pixels.Bgr(bytes) =>
      val bgr    = bytes.buffer
      val plane  = width * height
      val values = new Array[Float](3 * plane)
      val means  = Array(mean._1, mean._2, mean._3)
      val scales = Array(scale._1, scale._2, scale._3)
      for channel <- 0 until 3 do
        val byte = if redFirst then 2 - channel else channel
        var y    = 0
        while y < height do
          val row = (2L * y + 1) * image.height / (2L * height) * image.width
          var x   = 0
          while x < width do
            val column = (2L * x + 1) * image.width / (2L * width)
            val value  = bgr.get((3 * (row + column)).toInt + byte) & 0xff
            values(channel * plane + y * width + x) = (value - means(channel)) * scales(channel)
            x += 1
          y += 1
      Right(values)
    case other => Left(s"expected raw pixels, came ${other.productPrefix}")
