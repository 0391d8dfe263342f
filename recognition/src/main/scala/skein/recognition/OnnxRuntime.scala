package skein.recognition

/** Whether onnxruntime is there: it is larger than all else, and so whoever runs models adds it. */
private[recognition] object OnnxRuntime:

  def present[A](use: => Either[String, A]): Either[String, A] =
    try use
    catch
      case missing: LinkageError =>
        Left(
          "onnxruntime, which runs models, is not on the class path " +
            s"(docs/guides/onnx.md says how to add it): $missing"
        )
