package skein.policy

/** Code of a user's own threw something, or answered with what nobody can use.
  *
  * @param whose for example `the policy of Scout 1`
  */
final class OwnFailure(whose: String, reason: String, cause: Throwable | Null = null)
    extends RuntimeException(s"$whose $reason", cause)

object OwnFailure:

  /** What a user's code answers; its mistakes are told with whose it is, and the line. What came of a
    * connection, no `RuntimeException`, is told as it is.
    *
    * @throws OwnFailure if it throws
    */
  def told[A](whose: => String)(answer: => A): A =
    // Not `NonFatal`: a recursion without end and a class that is missing are mistakes of the user's too.
    try answer
    catch
      case told: OwnFailure => throw told
      case mistake: (RuntimeException | StackOverflowError | LinkageError | AssertionError |
            NotImplementedError) =>
        throw OwnFailure(whose, s"failed: ${text(mistake)}", mistake)

  /** The mistake, and where it was made if that is known. */
  def text(mistake: Throwable): String =
    s"$mistake${line(mistake.getStackTrace).fold("")(" (" + _ + ")")}"

  /** Where the user's code itself was, rather than what it called. */
  def line(frames: Iterable[StackTraceElement]): Option[String] =
    frames
      .find(frame => !Libraries.exists(frame.getClassName.startsWith))
      .map(frame => s"${frame.getFileName}:${frame.getLineNumber}")

  /** The one that another error came of. */
  def behind(error: Throwable): Option[OwnFailure] =
    Iterator
      .iterate(error)(_.getCause)
      .takeWhile(_ != null)
      .collectFirst { case failure: OwnFailure => failure }

  private val Libraries = Seq("java.", "jdk.", "scala.")
