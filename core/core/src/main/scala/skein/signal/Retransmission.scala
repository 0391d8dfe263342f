package skein.signal

import skein.units.*

/** Computes when TCP sends a lost packet again, as Linux does. */
object Retransmission:
  /** Minimum of the time-out beyond the mean round trip (`TCP_RTO_MIN`). */
  val LeastVariance: Span = Span.ofMillis(200)

  /** Maximum of the time-out, however often a packet was lost (`TCP_RTO_MAX`). */
  val Most: Span = Span.ofSeconds(120)

  /** The time-out of a connection that has no round trip yet, while it connects (RFC 6298, section 2.1). */
  val First: Span = Span.ofSeconds(1)

  /** The time-out at which Linux's estimator settles on this link: RTO = SRTT + max(200 ms, 4 RTTVAR), as in
    * RFC 6298 with Linux's minimum, from the mean and the mean deviation of the profile's round trips.
    */
  def timeout(profile: LatencyProfile): Span =
    profile.meanRoundTrip + LeastVariance.max(profile.meanDeviation * 4)

  /** Time after which a packet counts as lost and not as overtaken, if a later packet was acknowledged: one
    * and a quarter round trips (RFC 8985, section 6.2).
    */
  def overtaken(profile: LatencyProfile): Span = profile.meanRoundTrip + profile.meanRoundTrip / 4

  /** The time-out after one that has expired (RFC 6298, section 5.5). */
  def next(wait: Span): Span = Most.min(wait * 2)

  /** Time from the first try to send a packet until the successful one. The sender has no other packets, and
    * doubles its time-out with every try.
    *
    * @param first the first time-out
    * @param mostTries maximum number of times that the packet is sent again; the last one is not lost
    * @param isLost whether a try is lost, from the number of earlier tries and the time since the first
    */
  inline def wait(first: Span, mostTries: Int)(inline isLost: (Int, Span) => Boolean): Span =
    var waited  = Span.Zero
    var timeout = first
    var tries   = 0
    while tries < mostTries && isLost(tries, waited) do
      waited = waited + timeout
      timeout = next(timeout)
      tries += 1
    waited
