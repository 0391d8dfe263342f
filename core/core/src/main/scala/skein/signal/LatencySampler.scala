package skein.signal

import skein.units.*

/** Draws the delays of one direction of one connection. Mutable; one per direction and connection.
  *
  * @param linkSeed determines when the link is busy and which delays persist; must be equal for all
  *   connections and directions of a link, so that they agree
  * @param lineSeed determines the delays; different for each sampler
  */
final class LatencySampler(profile: LatencyProfile, linkSeed: Long, lineSeed: Long):
  private val random = SplitMix64(lineSeed)

  private val roundTrip: Span => LatencyDistribution = distributionOf(profile)
  private val share: Span => Double                  = shareOf(profile)

  private def distributionOf(profile: LatencyProfile): Span => LatencyDistribution = profile match
    case LatencyProfile.Steady(_, distribution)   => _ => distribution
    case alternating: LatencyProfile.Alternating  => Stretches(alternating, linkSeed).at
    case LatencyProfile.Correlated(_, latency, _) => distributionOf(latency)
    case LatencyProfile.Limited(_, latency, _)    => distributionOf(latency)
    case LatencyProfile.Impaired(_, latency, _)   => distributionOf(latency)

  private def shareOf(profile: LatencyProfile): Span => Double = profile match
    case LatencyProfile.Correlated(_, _, over)  => HeldShare(over, SplitMix64.seedOf(linkSeed, 1)).at
    case LatencyProfile.Limited(_, latency, _)  => shareOf(latency)
    case LatencyProfile.Impaired(_, latency, _) => shareOf(latency)
    case _                                      => _ => random.nextDouble()

  private val reordering = profile.impairments.collectFirst:
    case reordering: Impairment.Reordering => reordering

  /** The delay of the next message: half of a sampled round trip, and more if it is late
    * ([[Impairment.Reordering]]).
    *
    * @param sinceStart time since the link's start; must not decrease from call to call
    */
  def oneWay(sinceStart: Span): Span =
    val delay = roundTrip(sinceStart).quantile(share(sinceStart)) / 2
    reordering.filter(random.nextDouble() < _.share).fold(delay)(delay + _.by)

/** A number in [0, 1) that is redrawn after exponentially distributed times. */
private final class HeldShare(mean: Span, seed: Long):
  private val random = SplitMix64(seed)
  private var held   = random.nextDouble()
  private var until  = length()

  private def length(): Span = Span.ofSeconds(random.nextExponential(mean.toSeconds))

  def at(sinceStart: Span): Double =
    while sinceStart >= until do
      held = random.nextDouble()
      until = until + length()
    held

/** The sequence of the two distributions over time. */
private final class Stretches(profile: LatencyProfile.Alternating, seed: Long):
  private val random    = SplitMix64(seed)
  private val busyShare =
    profile.busyLasts.toSeconds / (profile.busyLasts.toSeconds + profile.quietLasts.toSeconds)
  private var busy  = random.nextDouble() < busyShare
  private var until = length()

  private def length(): Span =
    val mean = if busy then profile.busyLasts else profile.quietLasts
    Span.ofSeconds(random.nextExponential(mean.toSeconds))

  def at(sinceStart: Span): LatencyDistribution =
    while sinceStart >= until do
      busy = !busy
      until = until + length()
    if busy then profile.busy else profile.quiet
