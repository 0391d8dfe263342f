package skein.cli

import skein.report.Section

/** What a command has to show, on standard output: for people, or with `--json` for scripts. */
private[cli] final class Shown(asJson: Boolean):

  /** Tables alone are data.
    *
    * @param text what people see in their place
    */
  def tables(sections: Seq[Section], text: => String): Unit =
    Console.out.println(if asJson then Section.json(sections) else text)

  /** What else is to be said; beside data it goes to the error output. */
  def say(line: String): Unit = (if asJson then Console.err else Console.out).println(line)

private[cli] object Shown:
  /** What the option does, in every command that has it. */
  final val Doc = "tables as JSON on standard output, for scripts; everything else goes to standard error"
