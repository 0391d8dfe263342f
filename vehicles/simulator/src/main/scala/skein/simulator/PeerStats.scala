package skein.simulator

import java.util.concurrent.atomic.AtomicLong

/** Losses of MAVLink peers and autopilots since the start.
  *
  * @param damaged messages with a wrong checksum, of an unknown kind or with invalid content
  * @param dropped pieces for peers that did not take them in time
  * @param turnedAway peers beyond the limit
  * @param ignored datagrams of peers beyond a port's limit, of another protocol, or received faster than they
  *   were handled
  * @param unanswered how often an autopilot in lockstep did not answer within a second, and physics continued
  *   without it
  * @param foreign connections closed because they did not begin as the protocol does
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
  val damaged: AtomicLong    = AtomicLong()
  val dropped: AtomicLong    = AtomicLong()
  val turnedAway: AtomicLong = AtomicLong()
  val unanswered: AtomicLong = AtomicLong()
  val foreign: AtomicLong    = AtomicLong()

  def stats: PeerStats =
    PeerStats(damaged.get, dropped.get, turnedAway.get, unanswered = unanswered.get, foreign = foreign.get)
