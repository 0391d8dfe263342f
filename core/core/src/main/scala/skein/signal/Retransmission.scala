package skein.signal

import skein.units.*

/** When TCP sends a packet again that was lost. */
object Retransmission:
  /** Linux waits this long beyond the mean round trip at least (`TCP_RTO_MIN`). */
  val LeastVariance: Span = Span.ofMillis(200)

  /** Linux waits no longer than this (`TCP_RTO_MAX`). */
  val Most: Span = Span.ofSeconds(120)

  /** The time-out of a connection without any round trip yet (RFC 6298, section 2.1): of connecting. */
  val First: Span = Span.ofSeconds(1)

  /** The time-out to which Linux's estimator settles on this link: RTO = SRTT + max(200 ms, 4 RTTVAR), RFC
    * 6298 with the floor of Linux, by the mean and the mean deviation of the profile's round trips.
    */
  def timeout(profile: LatencyProfile): Span =
    profile.meanRoundTrip + LeastVariance.max(profile.meanDeviation * 4)

  /** How long after it was sent a packet counts as lost, and not as overtaken, if a later one has been
    * acknowledged: a round trip and a quarter (RFC 8985, section 6.2).
    */
  def overtaken(profile: LatencyProfile): Span = profile.meanRoundTrip + profile.meanRoundTrip / 4

  /** The next wait after one that ended in vain (RFC 6298, section 5.5). */
  def next(wait: Span): Span = Most.min(wait * 2)

  /** How long a packet is sent in vain, by a sender without other packets that waits longer and longer before
    * it sends again.
    *
    * @param first the first time-out
    * @param mostTries with which it is sent again; the last one passes
    * @param isLost given the number of tries before, and for how long they were in vain
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
