package skein.cli

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.UTF_8

/** The result of a command that ran in this process.
  *
  * @param status exit status
  */
private[cli] final case class Ran(status: Int, out: String, err: String):

  /** Both outputs, standard error first. */
  def said: String = err + out

private[cli] object Ran:
  def of(command: => Int): Ran =
    val (out, err) = (ByteArrayOutputStream(), ByteArrayOutputStream())
    val status     = Console.withOut(out)(Console.withErr(err)(command))
    Ran(status, out.toString(UTF_8), err.toString(UTF_8))
