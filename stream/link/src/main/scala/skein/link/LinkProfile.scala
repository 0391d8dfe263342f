package skein.link

import skein.signal.LatencyProfile

/** The properties of a link.
  *
  * @param toServer delays towards the server; a rate in it ([[LatencyProfile.Limited]]) is that of one line
  *   for all connections
  * @param toClient delays in the opposite direction, which has a line of its own
  * @param maxBytesInFlight maximum number of bytes that one direction of a connection holds (in addition to
  *   the segment that exceeds it); then the sender waits, as with TCP's window
  * @param duplicates share of datagrams that arrive twice, each time with a delay of its own; TCP discards
  *   duplicates, so it has none
  * @param cutsSegments whether bytes arrive in segments that are cut anywhere, for tests of their readers
  */
final case class LinkProfile(
    toServer: LatencyProfile,
    toClient: LatencyProfile,
    faults: Faults = Faults.none,
    maxBytesInFlight: Int = 4 * 1024 * 1024,
    cutsSegments: Boolean = false,
    duplicates: Double = 0
):
  require(duplicates >= 0 && duplicates <= 1, s"duplicates are a share, got $duplicates")
  require(maxBytesInFlight > 0, s"a link holds at least one byte, got $maxBytesInFlight")

object LinkProfile:

  /** A profile with equal delays in both directions, and no faults. */
  def symmetric(latency: LatencyProfile): LinkProfile = LinkProfile(latency, latency)

  val none: LinkProfile = symmetric(LatencyProfile.none)
