package skein.cli

import skein.report.Section

/** A command's results on standard output: for people, or with `--json` for scripts. */
private[cli] final class Shown(asJson: Boolean):

  /** With `--json`, prints the tables as JSON; otherwise prints `text`.
    *
    * @param text printed without `--json`
    * @param more further fields of the JSON
    */
  def tables(sections: Seq[Section], text: => String, more: (String, ujson.Value)*): Unit =
    Console.out.println(if asJson then Section.json(sections, more*) else text)

  /** Prints a remark; with `--json` to the error output. */
  def say(line: String): Unit = (if asJson then Console.err else Console.out).println(line)

private[cli] object Shown:
  /** The help text of `--json`, in every command that has it. */
  final val Doc = "tables as JSON on standard output, for scripts; everything else goes to standard error"
