package skein.units

import scala.util.control.ControlThrowable

/** Thrown when user code throws an exception or returns an unusable value.
  *
  * @param whose the origin of the code, for example `the policy of Scout 1`
  */
final class OwnFailure(whose: String, reason: String, cause: Throwable | Null = null)
    extends RuntimeException(s"$whose $reason", cause):

  /** Only the message, without the class name, because it is for users, also if another process has sent it.
    */
  override def toString: String = getMessage

object OwnFailure:

  /** Evaluates user code. An exception is rethrown with the code's origin and source line; exhausted memory,
    * an interrupt and a [[ControlThrowable]] are rethrown unchanged.
    *
    * @throws OwnFailure if the code throws
    */
  def told[A](whose: => String)(answer: => A): A =
    // Not `NonFatal`, because an endless recursion and a missing class are users' mistakes too.
    try answer
    catch
      case asItIs: (OwnFailure | InterruptedException | OutOfMemoryError | ControlThrowable) => throw asItIs
      case mistake: Throwable => throw OwnFailure(whose, s"failed: ${text(mistake)}", mistake)

  /** The kind and class of user code as words, for example `the policy Chase`. */
  private[skein] def named(kind: String, own: Any): String = own.getClass.getSimpleName.stripSuffix("$") match
    case ""   => s"a $kind without a name"
    case name => s"the $kind $name"

  /** The exception as text, with its source line if known. */
  private def text(mistake: Throwable): String = mistake match
    case shell: ExceptionInInitializerError if shell.getCause != null => text(shell.getCause)
    case _ => s"$mistake${line(own(mistake.getStackTrace.toVector)).fold("")(" (" + _ + ")")}"

  /** The stack frames in the package of the user code, without those of libraries that it calls. */
  private def own(frames: Vector[StackTraceElement]): Vector[StackTraceElement] =
    val (asked, asking) = frames.span(frame => frame.getClassName != getClass.getName)
    // Without a frame of this object, the exception was created elsewhere than thrown.
    val room = asked.findLast(isUsers).filter(_ => asking.nonEmpty).map(_.getClassName)
    room.fold(asked)(name => asked.filter(_.getClassName.startsWith(name.take(name.lastIndexOf('.') + 1))))

  /** The source line in user code, rather than in code that it calls. */
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
