package skein.rpc

import skein.units.*

/** The time for which one connection has kept its server waiting, counted in steps of [[ServerLimits.Watch]].
  * Knows no clock.
  */
private[rpc] final class Patience(limits: ServerLimits):
  private var midway           = 0
  private var untaken          = 0
  private var quiet            = 0
  @volatile private var silent = 0

  /** Time without anything received or in progress. A peer that awaits an answer and sends nothing for more
    * than [[ServerLimits.waiting]] counts as silent from then on. From any thread.
    */
  def silentFor: Span = ServerLimits.Watch * silent.toLong

  def came(): Unit =
    silent = 0
    quiet = 0

  def completed(): Unit = midway = 0

  def taken(): Unit = untaken = 0

  /** Counts one watch; returns why the connection must be closed, if so.
    *
    * @param forMessage the server waits for the rest of a message
    * @param forTaking replies wait to be taken
    * @param forNothing neither of these, and no request is in progress
    */
  def watch(forMessage: Boolean, forTaking: Boolean, forNothing: Boolean): Option[(ServerLimit, String)] =
    midway = if forMessage then midway + 1 else 0
    untaken = if forTaking then untaken + 1 else 0
    quiet += 1
    silent = if forNothing || ServerLimits.Watch * quiet.toLong > limits.waiting then silent + 1 else 0
    if lasts(midway, limits.messageTime) then
      Some(ServerLimit.Time -> s"a message under way for more than ${seconds(limits.messageTime)}")
    else if lasts(untaken, limits.replyTime) then
      Some(ServerLimit.Time -> s"replies not taken for more than ${seconds(limits.replyTime)}")
    else if forNothing && lasts(silent, limits.idle) then
      Some(ServerLimit.Idle -> s"silent for more than ${seconds(limits.idle)}")
    else None

  /** Whether `watches` exceed `longest`; the first watch may be arbitrarily short. */
  private def lasts(watches: Int, longest: Span): Boolean =
    ServerLimits.Watch * (watches - 1).toLong >= longest

  private def seconds(span: Span): String = s"${math.round(span.toSeconds)} s"
