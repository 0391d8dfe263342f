package skein.units

import scala.util.control.ControlThrowable

/** User code threw an exception, or returned a value that is unusable.
  *
  * @param whose for example `the policy of Scout 1`
  */
final class OwnFailure(whose: String, reason: String, cause: Throwable | Null = null)
    extends RuntimeException(s"$whose $reason", cause):

  /** The message alone: it is for people, also if it was sent by another process. */
  override def toString: String = getMessage

object OwnFailure:

  /** Evaluates user code; an exception is rethrown with its origin and source line. Exhausted memory, the end
    * of a thread and a [[ControlThrowable]] pass unchanged.
    *
    * @throws OwnFailure if it throws
    */
  def told[A](whose: => String)(answer: => A): A =
    // Not `NonFatal`: a recursion without end and a class that is missing are mistakes of the user's too.
    try answer
    catch
      case asItIs: (OwnFailure | InterruptedException | OutOfMemoryError | ControlThrowable) => throw asItIs
      case mistake: Throwable => throw OwnFailure(whose, s"failed: ${text(mistake)}", mistake)

  /** Names the code by its kind and class: `the policy Chase`. */
  private[skein] def named(kind: String, own: Any): String = own.getClass.getSimpleName.stripSuffix("$") match
    case ""   => s"a $kind without a name"
    case name => s"the $kind $name"

  /** The mistake, and its source line if known. */
  private def text(mistake: Throwable): String = mistake match
    case shell: ExceptionInInitializerError if shell.getCause != null => text(shell.getCause)
    case _ => s"$mistake${line(own(mistake.getStackTrace.toVector)).fold("")(" (" + _ + ")")}"

  /** The stack frames in the package of the called user code, rather than those of libraries that it called.
    */
  private def own(frames: Vector[StackTraceElement]): Vector[StackTraceElement] =
    val (asked, asking) = frames.span(frame => frame.getClassName != getClass.getName)
    // Without who asked, it was made elsewhere than thrown.
    val room = asked.findLast(isUsers).filter(_ => asking.nonEmpty).map(_.getClassName)
    room.fold(asked)(name => asked.filter(_.getClassName.startsWith(name.take(name.lastIndexOf('.') + 1))))

  /** The source line within user code, rather than within what it called. */
  def line(frames: Iterable[StackTraceElement]): Option[String] =
    frames
      .find(isUsers)
      .orElse(frames.find(!isOf(Libraries, _)))
      .map(frame => s"${frame.getFileName}:${frame.getLineNumber}")

  private def isUsers(frame: StackTraceElement) = !isOf(Libraries, frame) && !isOf(Skein, frame)

  private def isOf(rooms: Seq[String], frame: StackTraceElement) =
    rooms.exists(frame.getClassName.startsWith)

  /** The [[OwnFailure]] among an error's causes, if any. */
  def behind(error: Throwable): Option[OwnFailure] =
    Iterator
      .iterate(error)(_.getCause)
      .takeWhile(_ != null)
      .collectFirst { case failure: OwnFailure => failure }

  private val Libraries = Seq("java.", "jdk.", "scala.", "org.apache.")
  private val Skein     = Seq("skein.")
