package skein.simulator

import java.util.concurrent.atomic.AtomicLong

/** What peers of MAVLink lost since the start.
  *
  * @param damaged
  *   frames that came with a wrong checksum, of an unknown message or of a wrong content
  * @param dropped
  *   datagrams to peers that did not take them in time
  * @param turnedAway
  *   peers beyond the most at a time
  * @param ignored
  *   datagrams of peers beyond the most at a port, or that came faster than they were dealt with
  */
final case class MavlinkStats(damaged: Long = 0, dropped: Long = 0, turnedAway: Long = 0, ignored: Long = 0)

private[simulator] final class MavlinkCounters:
  val damaged: AtomicLong    = AtomicLong()
  val dropped: AtomicLong    = AtomicLong()
  val turnedAway: AtomicLong = AtomicLong()

  def stats: MavlinkStats = MavlinkStats(damaged.get, dropped.get, turnedAway.get)
