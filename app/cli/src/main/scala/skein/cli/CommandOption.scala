package skein.cli

/** An option of a command, for help texts and shell completion.
  *
  * @param flag with its dashes; empty for positional words, such as files
  * @param value placeholder of its value in help; none for a flag alone
  * @param default its value if it is not given, unless the summary states it
  * @param values all its values, if the set is known; empty if it accepts others, such as file names
  */
private[cli] final case class CommandOption(
    flag: String,
    summary: String,
    value: Option[String],
    default: Option[String],
    values: Seq[String]
):
  def takesValue: Boolean = value.isDefined
