package skein.cli

import java.io.PrintStream

/** A line with the progress and remaining time of long work: rewritten on a terminal, else printed every 5 s.
  *
  * @param total amount of work
  * @param from part that was done before this run
  */
private[cli] final class ProgressLine(total: Long, out: PrintStream, from: Long = 0):
  private val isTerminal = Terminal.isThere
  private val startedAt  = System.nanoTime()
  private val every      = if isTerminal then 200_000_000L else 5_000_000_000L
  private var shownAt    = startedAt
  private var width      = 0

  /** @param text additional status, computed only if shown */
  def show(done: Long, text: => String): Unit =
    val now = System.nanoTime()
    if now - shownAt >= every then
      shownAt = now
      val share = 100.0 * done / total.max(1)
      val whole = f"$share%3.0f %%  ${left(now, done)}%-12s $text"
      if isTerminal then
        val line = ProgressLine.cut(whole, Terminal.width)
        out.print("\r" + line.padTo(width, ' '))
        out.flush()
        width = line.length
      else out.println(whole)

  /** Clears the line on a terminal. */
  def end(): Unit = if isTerminal && width > 0 then out.print("\r" + " " * width + "\r")

  private def left(now: Long, done: Long): String =
    // The first part runs while the just-in-time compiler still works, and is not a measure of the rate.
    if done - from < (total / 200).max(1) then ""
    else
      val seconds = (now - startedAt) * 1e-9 * (total - done).max(0) / (done - from)
      if seconds < 100 then f"$seconds%.0f s left"
      else if seconds < 6000 then f"${seconds / 60}%.0f min left"
      else f"${seconds / 3600}%.1f h left"

private[cli] object ProgressLine:

  /** Cuts a text to one line of a terminal. The last column stays free: some terminals wrap as soon as it is
    * written.
    */
  def cut(line: String, width: Option[Int]): String = width match
    case Some(columns) if line.length >= columns => (line.take((columns - 2).max(0)) + "…").take(columns - 1)
    case _                                       => line
