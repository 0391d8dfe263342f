package skein.cli

import java.io.{IOException, PrintStream}
import java.lang.ProcessBuilder.Redirect
import skein.observe.OutsideProgram

/** Runs programs in this terminal, with its input and outputs. */
private[cli] object InTerminal:
  private val RestMillis = 1_000L

  /** Runs a program to its end; Ctrl-C ends it.
    *
    * @param forScripts whether our own standard output is for scripts: the program's goes to standard error
    * @return its exit status; Left says why it cannot be started
    */
  def run(command: Seq[String], forScripts: Boolean): Either[String, Int] =
    try
      val builder = ProcessBuilder(command*).inheritIO()
      if forScripts then builder.redirectOutput(Redirect.PIPE): Unit
      val program = builder.start()
      val err     = Console.err
      // Without a pipe there is nothing to copy.
      val copying = Thread.ofVirtual().start(() => copied(program, err))
      Edge.untilInterrupted(() => OutsideProgram.stop(program)):
        val status = program.waitFor()
        copying.join(RestMillis): Unit
        Right(status)
    catch case absent: IOException => Left(s"cannot start ${command.head}: ${absent.getMessage}")

  private def copied(program: Process, to: PrintStream): Unit =
    try program.getInputStream.transferTo(to): Unit
    catch case _: IOException => () // its end closed the pipe
