package skein.policy

/** Runs models that are no networks of ours. Those on the class path are found by `java.util.ServiceLoader`.
  */
trait ModelRunner:

  /** @param model an ONNX file's bytes, with one input of 32-bit floats and one output
    * @return what it answers to a tensor of a shape: any thread, several at once, or why it does not; or why
    *   it cannot be run
    */
  def load(model: Array[Byte]): Either[String, (Array[Float], Vector[Int]) => Either[String, Array[Float]]]
