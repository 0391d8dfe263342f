package skein.policy

/** Runs models in formats other than Skein's own networks. Implementations on the class path are found by
  * `java.util.ServiceLoader`.
  */
trait ModelRunner:

  /** Loads an ONNX model.
    *
    * @param model the file's bytes, with one input of 32-bit floats and one output
    * @return a function from a tensor and its shape to the output tensor; several threads may call it
    *   simultaneously; Left says why the model cannot be run
    */
  def load(model: Array[Byte]): Either[String, (Array[Float], Vector[Int]) => Either[String, Array[Float]]]
