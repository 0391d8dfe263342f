package skein.recognition

/** Determines whether onnxruntime is available. It is larger than all other libraries, so users of models add
  * it themselves.
  */
private[recognition] object OnnxRuntime:
  /** Commands that download and use it; equal to those in docs/guides/onnx.md. */
  val Fetch =
    "mvn dependency:copy -Dartifact=com.microsoft.onnxruntime:onnxruntime:1.26.0 -DoutputDirectory=."
  val Use = "JAVA_OPTS=-Xbootclasspath/a:onnxruntime-1.26.0.jar"

  def present[A](use: => Either[String, A]): Either[String, A] =
    try use
    catch case error: LinkageError => Left(why(error))

  /** Explains missing classes, and classes that cannot be initialised on this machine. */
  private[recognition] def why(error: LinkageError): String = error match
    case _: NoClassDefFoundError if error.getMessage.startsWith("ai/onnxruntime/") =>
      s"onnxruntime, which runs models, is not on the class path: get it by '$Fetch', and begin the " +
        s"command with $Use (docs/guides/onnx.md)"
    case _ => s"onnxruntime, which runs models, cannot be loaded on this machine: ${reason(error)}"

  private def reason(error: Throwable): String =
    Iterator.iterate(error)(_.getCause).takeWhile(_ != null).flatMap(cause => Option(cause.getMessage))
      .nextOption().getOrElse(error.toString)
