package skein.cli

/** An option of a command, as a shell completes it.
  *
  * @param flag
  *   with its dashes
  * @param values
  *   all that it takes, where that is known; else any, a file's name perhaps
  */
private[cli] final case class CommandOption(
    flag: String,
    summary: String,
    takesValue: Boolean,
    values: Seq[String]
)
