package skein.signal

import skein.units.*

/** The delays of one direction of a link, given by the measured distribution of its round trips. One
  * direction takes half of a sampled round trip. The two directions sample independently, so that a round
  * trip spreads less than what was measured, by a factor of √2; under [[LatencyProfile.Correlated]] it
  * spreads as measured.
  */
enum LatencyProfile:

  /** Successive round trips are independent and their distribution never changes. */
  case Steady(name: String, roundTrip: LatencyDistribution)

  /** A link that is busy for a while and then quiet for a while; the lengths of these stretches are
    * exponentially distributed around `busyLasts` and `quietLasts`. Within a stretch successive round trips
    * are independent.
    */
  case Alternating(
      name: String,
      busy: LatencyDistribution,
      quiet: LatencyDistribution,
      busyLasts: Span,
      quietLasts: Span
  )

  /** Another profile whose delays persist for a while: the share p at which its distribution is read is
    * redrawn after exponentially distributed times of mean `over`, simultaneously for both directions and all
    * connections of a link. Every delay is distributed as before, and the correlation of p at two moments is
    * e^(−t/over): a round trip much shorter than `over` takes as long as one that was measured.
    */
  case Correlated(name: String, latency: LatencyProfile, over: Span)

  /** Another profile behind a line of limited rate, where bytes wait. */
  case Limited(name: String, latency: LatencyProfile, rate: Bandwidth)

  /** Another profile that also loses packets. */
  case Impaired(name: String, latency: LatencyProfile, by: Impairment)

  /** The text that [[LatencyProfile.parse]] reads back as this profile. */
  def name: String

  /** The rate of the line before it, if it is limited. */
  def bandwidth: Option[Bandwidth] = this match
    case Limited(_, _, rate) => Some(rate)
    case _                   => within.flatMap(_.bandwidth)

  /** How it loses packets, outermost first; empty if it loses none. */
  def impairments: Vector[Impairment] = this match
    case Impaired(_, latency, by) => by +: latency.impairments
    case _                        => within.fold(Vector.empty)(_.impairments)

  /** The delays alone, without rate and losses. */
  def delays: LatencyProfile = this match
    case Limited(_, latency, _)                                       => latency.delays
    case Impaired(_, latency, _)                                      => latency.delays
    case Correlated(name, latency, over) if latency.delays != latency =>
      Correlated(name, latency.delays, over)
    case _ => this

  /** The profile that this one modifies. */
  private[signal] def within: Option[LatencyProfile] = this match
    case Steady(_, _) | Alternating(_, _, _, _, _) => None
    case Correlated(_, latency, _)                 => Some(latency)
    case Limited(_, latency, _)                    => Some(latency)
    case Impaired(_, latency, _)                   => Some(latency)

  /** Mean round trip, without waiting for a rate or for packets sent again. */
  def meanRoundTrip: Span = Span.ofMillis(average(_.mean.toMillis))

  /** Mean deviation of round trips from their mean, E|t − E t|. */
  def meanDeviation: Span =
    val mean = meanRoundTrip.toMillis
    Span.ofMillis(average: distribution =>
      val parts = 1000
      (0 until parts).map(i => (distribution.quantile((i + 0.5) / parts).toMillis - mean).abs).sum / parts)

  private def average(of: LatencyDistribution => Double): Double = this match
    case Steady(_, roundTrip)                             => of(roundTrip)
    case Alternating(_, busy, quiet, busyLasts, notLasts) =>
      val share = busyLasts.toSeconds / (busyLasts.toSeconds + notLasts.toSeconds)
      share * of(busy) + (1 - share) * of(quiet)
    case _ => within.fold(0.0)(_.average(of))

object LatencyProfile:
  val none: LatencyProfile   = Steady("none", LatencyDistribution.Constant(Span.Zero))
  val direct: LatencyProfile = Steady("direct", LatencyDistribution.Direct)
  val vpn: LatencyProfile    = Steady("vpn", LatencyDistribution.Vpn)

  /** The paper's VPN over a long time: busy in 393 of 935 samples, else like the direct link. It was measured
    * once, one stretch of each, so only the shares are its own; that a pair of stretches takes 95 s is our
    * choice.
    */
  val vpnMixed: Alternating = new Alternating(
    "vpn-mixed",
    busy = LatencyDistribution.Vpn,
    quiet = LatencyDistribution.Direct,
    busyLasts = Span.ofSeconds(40),
    quietLasts = Span.ofSeconds(55)
  )

  /** Reads a profile from its text form: `none`, `direct`, `vpn`, `vpn-mixed`, `constant:200ms`,
    * `uniform:10ms..40ms`, `lognormal:36ms,0.3` (median, standard deviation of the logarithm), `file:PATH`
    * (round trips in ms, one a line; empty lines and lines that start with # are skipped). All times are
    * round trips; units are `us`, `ms`, `s`. Before any of them may stand, each once and in any order:
    * `correlated:250ms,`; `rate:50mbit,` or `rate:50mbit/64kB,` ([[Bandwidth.parse]]); `loss:5%,`, or
    * `loss:5%/4,` in bursts of four packets on average ([[Impairment.Loss]]); `outage:1s/10s,`, for 1 s every
    * 10 s on average ([[Impairment.Outage]]).
    *
    * @param read returns the text of the file at a path, or why it cannot
    */
  def parse(text: String, read: String => Either[String, String]): Either[LatencyError, LatencyProfile] =
    LatencyText.parse(text, read)
