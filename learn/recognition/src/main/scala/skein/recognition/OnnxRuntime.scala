package skein.recognition

/** Whether onnxruntime is there: it is larger than all else, and so whoever runs models adds it. */
private[recognition] object OnnxRuntime:
  /** How it is got, and used; docs/guides/onnx.md has the same. */
  val Fetch =
    "mvn dependency:copy -Dartifact=com.microsoft.onnxruntime:onnxruntime:1.26.0 -DoutputDirectory=."
  val Use = "JAVA_OPTS=-Xbootclasspath/a:onnxruntime-1.26.0.jar"

  def present[A](use: => Either[String, A]): Either[String, A] =
    try use
    catch case error: LinkageError => Left(why(error))

  /** Of classes that are not there, and of those that are and do not start on this machine. */
  private[recognition] def why(error: LinkageError): String = error match
    case _: NoClassDefFoundError if error.getMessage.startsWith("ai/onnxruntime/") =>
      s"onnxruntime, which runs models, is not on the class path: get it by '$Fetch', and begin the " +
        s"command with $Use (docs/guides/onnx.md)"
    case _ => s"onnxruntime, which runs models, cannot be loaded on this machine: ${reason(error)}"

  private def reason(error: Throwable): String =
    Iterator.iterate(error)(_.getCause).takeWhile(_ != null).flatMap(cause => Option(cause.getMessage))
      .nextOption().getOrElse(error.toString)
