package skein.cli

/** An option of a command, for help texts and shell completion.
  *
  * @param flag the option with its dashes; empty for positional words, such as files
  * @param value placeholder of its value in help; none for a flag
  * @param default the option's value if it is not given, unless the summary states it
  * @param values all accepted values, if the set is known; empty if it accepts others, such as file names
  */
private[cli] final case class CommandOption(
    flag: String,
    summary: String,
    value: Option[String],
    default: Option[String],
    values: Seq[String]
):
  def takesValue: Boolean = value.isDefined
