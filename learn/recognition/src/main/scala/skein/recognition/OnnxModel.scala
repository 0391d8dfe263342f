package skein.recognition

import ai.onnxruntime.{OnnxTensor, OrtEnvironment, OrtException, OrtSession}
import java.nio.FloatBuffer
import java.nio.file.Path
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.airsim.Image

/** A model's outputs by name: their elements, row by row, and their shape. */
type Outputs = Map[String, OnnxModel.Output]

/** Any ONNX model with one input of floats, such as an object detector. Thread-safe.
  *
  * @param input shape of its input; −1 for any size
  */
final class OnnxModel private (session: OrtSession, inputName: String, val input: Vector[Int])
    extends AutoCloseable:

  /** Runs the model on a tensor of the given shape. Left says what the model does not accept. */
  def run(tensor: Array[Float], shape: Vector[Int]): Either[String, Outputs] =
    if shape.map(_.toLong).product != tensor.length then
      Left(s"expected ${shape.mkString(" × ")} numbers, got ${tensor.length}")
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

  /** Runs the model on an image, converted to the form that it was trained on. */
  def run(image: Image, form: InputForm): Either[String, Outputs] =
    form.tensor(image).flatMap(run(_, Vector(1, 3, form.height, form.width)))

  def close(): Unit = session.close()

object OnnxModel:
  /** @param values the elements, row by row; integers are converted to floats */
  final case class Output(shape: Vector[Int], values: Array[Float])

  private lazy val environment = OrtEnvironment.getEnvironment()

  /** @param threads number of threads that compute one image; several images at a time (`Recognise`) need one
    *   each
    * @return Left says why the file is not such a model
    */
  def load(file: Path, threads: Int = 1): Either[String, OnnxModel] =
    if !java.nio.file.Files.isReadable(file) then
      Left(s"$file: expected an ONNX model, there is no such file")
    else of(environment.createSession(file.toString, _), threads).left.map(reason => s"$file: $reason")

  /** Reads a model from its bytes, in the manner of `load`. */
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
            "expected a model with one input of floats, got " +
              s"${other.map((name, info) => s"$name: $info").mkString("; ")}"
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
