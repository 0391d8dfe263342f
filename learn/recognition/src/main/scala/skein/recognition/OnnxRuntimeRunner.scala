package skein.recognition

import skein.policy.ModelRunner

/** Runs ONNX policies with onnxruntime, if it is on the class path; on one thread, so that equal inputs have
  * equal outputs.
  */
final class OnnxRuntimeRunner extends ModelRunner:

  def load(model: Array[Byte]): Either[String, (Array[Float], Vector[Int]) => Either[String, Array[Float]]] =
    OnnxRuntime.present(OnnxModel.read(model).map: loaded =>
      (numbers, shape) => loaded.run(numbers, shape).map(_.values.head.values))
