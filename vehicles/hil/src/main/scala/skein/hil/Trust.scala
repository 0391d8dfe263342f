package skein.hil

/** Decides whether time may wait for an autopilot. Time waits until a wait was in vain; then the autopilot
  * must first give a number of answers in a row while time continues without it. The number doubles each
  * time: an autopilot that answers just often enough to be waited for again slows the others little in the
  * long run.
  *
  * @param before number of waits for it that were in vain before it connected
  */
private[hil] final class Trust(before: Int = 0):
  import Trust.*

  private var times      = before
  private var isGivenNow = before == 0
  private var inARow     = 0

  def isGiven: Boolean = isGivenNow

  def losses: Int = times

  /** Handles a wait that was in vain: time waits no longer. */
  def lose(): Unit =
    if isGivenNow then times += 1
    isGivenNow = false
    inARow = 0

  /** Handles an answer in time: after enough of these in a row, time waits again. */
  def answered(): Unit = if !isGivenNow then
    inARow += 1
    if inARow >= (First << (times - 1).min(10)).min(Most) then isGivenNow = true

  /** Handles an answer that is not in time: counting starts again. */
  def missed(): Unit = inARow = 0

private object Trust:
  /** Answers that PX4 gives in a second, and in a minute. */
  val First = 250
  val Most  = 15_000
