package skein.docs

import skein.cli.Main

/** All commands with their options as a page of the documentation. */
object CommandReference:

  /** The `--help` of every command, as Markdown. */
  def markdown: String =
    val commands = Main.commands.map: command =>
      s"## ${command.name}\n\n${command.summary.capitalize}.\n\n```\n${command.help.stripTrailing}\n```\n"
    s"$introduction\n${commands.mkString("\n")}"

  private val introduction =
    """# Commands
      |
      |`./skein COMMAND --help` shows the same. `source <(./skein completion bash)` completes commands, options and known values; `zsh` works too.
      |
      |Exit status: 0 success; 1 failure, or something that cannot be flown; 2 unknown options, or values of the wrong kind. Progress and errors go to standard error, results to standard output.
      |""".stripMargin
