package skein.record

/** The outcome of a command in the form in which a recording stores it. */
private[record] final case class OutcomeCells(name: String, error: Option[String]):
  def outcome: CommandOutcome = name match
    case OutcomeCells.Done       => CommandOutcome.Done
    case OutcomeCells.Superseded => CommandOutcome.Superseded
    case text                    => CommandOutcome.Failed(error.getOrElse(text))

private[record] object OutcomeCells:
  private val Done       = "done"
  private val Superseded = "superseded"
  private val Failed     = "failed"

  def of(outcome: CommandOutcome): OutcomeCells = outcome match
    case CommandOutcome.Done          => OutcomeCells(Done, None)
    case CommandOutcome.Superseded    => OutcomeCells(Superseded, None)
    case CommandOutcome.Failed(error) => OutcomeCells(Failed, Some(error))
