package skein.link

import skein.signal.LatencyProfile

/** Everything that a link does to what crosses it.
  *
  * @param toServer delays towards the server; the rate that it may name ([[LatencyProfile.Limited]]) is that
  *   of a line which all connections share
  * @param toClient the same on the way back, where a line of its own lies
  * @param maxBytesInFlight what one direction of a connection holds at most (besides the segment that exceeds
  *   it); then the sender waits, as with TCP's window
  * @param cutsSegments whether bytes arrive in segments that are cut anywhere, for tests of what reads them
  */
final case class LinkProfile(
    toServer: LatencyProfile,
    toClient: LatencyProfile,
    faults: Faults = Faults.none,
    maxBytesInFlight: Int = 4 * 1024 * 1024,
    cutsSegments: Boolean = false
):
  require(maxBytesInFlight > 0, s"a link holds at least one byte, got $maxBytesInFlight")

object LinkProfile:

  /** The same profile in both directions, and no faults. */
  def symmetric(latency: LatencyProfile): LinkProfile = LinkProfile(latency, latency)

  val none: LinkProfile = symmetric(LatencyProfile.none)
