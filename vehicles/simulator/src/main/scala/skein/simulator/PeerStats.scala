package skein.simulator

import java.util.concurrent.atomic.AtomicLong

/** Losses of MAVLink peers and autopilots since the start.
  *
  * @param damaged number of messages with a wrong checksum, of an unknown kind or with invalid content
  * @param dropped number of pieces for peers that did not take them in time
  * @param turnedAway number of peers beyond the limit
  * @param ignored number of datagrams of peers beyond a port's limit, of another protocol, or received faster
  *   than they were handled
  * @param unanswered number of times that an autopilot in lockstep did not answer within a second, and
  *   physics continued without it
  * @param foreign number of connections closed because they did not begin as the protocol does
  */
final case class PeerStats(
    damaged: Long = 0,
    dropped: Long = 0,
    turnedAway: Long = 0,
    ignored: Long = 0,
    unanswered: Long = 0,
    foreign: Long = 0
)

private[simulator] final class PeerCounters:
  val damaged, dropped, turnedAway, unanswered, foreign = AtomicLong()

  def stats: PeerStats =
    PeerStats(damaged.get, dropped.get, turnedAway.get, unanswered = unanswered.get, foreign = foreign.get)
