package skein.signal

import skein.units.*

/** How long messages take over one direction of a link, as the distribution of round trips that was measured there.
  * One direction takes half of a sampled round trip; the two directions sample independently.
  */
enum LatencyProfile:

  /** Successive round trips are independent and their distribution never changes. */
  case Steady(name: String, roundTrip: LatencyDistribution)

  /** A link that is busy for a while and then quiet for a while; the lengths of these stretches are exponentially
    * distributed around `busyLasts` and `quietLasts`. Within a stretch successive round trips are independent.
    */
  case Alternating(
      name: String,
      busy: LatencyDistribution,
      quiet: LatencyDistribution,
      busyLasts: Span,
      quietLasts: Span
  )

  /** The text that [[LatencyProfile.parse]] reads back as this profile. */
  def name: String

object LatencyProfile:
  val none: LatencyProfile   = Steady("none", LatencyDistribution.Constant(Span.Zero))
  val direct: LatencyProfile = Steady("direct", LatencyDistribution.Direct)
  val vpn: LatencyProfile    = Steady("vpn", LatencyDistribution.Vpn)

  /** The paper's VPN over a long time: busy in 393 of 935 samples, else like the direct link. It was measured once,
    * one stretch of each, so only the shares are its own; that a pair of stretches takes 95 s is our choice.
    */
  val vpnMixed: LatencyProfile = Alternating(
    "vpn-mixed",
    busy = LatencyDistribution.Vpn,
    quiet = LatencyDistribution.Direct,
    busyLasts = Span.ofSeconds(40),
    quietLasts = Span.ofSeconds(55)
  )

  /** Reads a profile from its text form: `none`, `direct`, `vpn`, `vpn-mixed`, `constant:200ms`,
    * `uniform:10ms..40ms`, `lognormal:36ms,0.3` (median, standard deviation of the logarithm), `file:PATH` (round
    * trips in ms, one a line; empty lines and lines that start with # are skipped). All times are round trips; units
    * are `us`, `ms`, `s`.
    *
    * @param read
    *   gives the text of the file at a path, or says why it cannot
    */
  def parse(text: String, read: String => Either[String, String]): Either[LatencyError, LatencyProfile] =
    LatencyText.parse(text, read)
