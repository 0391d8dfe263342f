package skein.cli

/** An option of a command, as help tells it and a shell completes it.
  *
  * @param flag with its dashes; empty for what stands without one, files for example
  * @param value what stands for its value in help; none for a flag alone
  * @param default its value where it is not given, unless the summary says so
  * @param values all that it takes, where that is known; else any, a file's name perhaps
  */
private[cli] final case class CommandOption(
    flag: String,
    summary: String,
    value: Option[String],
    default: Option[String],
    values: Seq[String]
):
  def takesValue: Boolean = value.isDefined
