package skein.hil

/** Whether time may wait for an autopilot. It does until the autopilot was waited for in vain; then it must
  * first answer so many times in a row while time goes on without it. Twice as many after each further time:
  * whoever answers just often enough to be waited for again slows the others by little in the long run.
  *
  * @param before how often it was waited for in vain before it connected
  */
private[hil] final class Trust(before: Int = 0):
  import Trust.*

  private var times      = before
  private var isGivenNow = before == 0
  private var inARow     = 0

  def isGiven: Boolean = isGivenNow

  /** How often it was lost. */
  def losses: Int = times

  /** It was waited for in vain. */
  def lose(): Unit =
    if isGivenNow then times += 1
    isGivenNow = false
    inARow = 0

  /** It has answered in time. */
  def answered(): Unit = if !isGivenNow then
    inARow += 1
    if inARow >= (First << (times - 1).min(10)).min(Most) then isGivenNow = true

  /** It has not. */
  def missed(): Unit = inARow = 0

private object Trust:
  /** A second of PX4's answers, and a minute's. */
  val First = 250
  val Most  = 15_000
