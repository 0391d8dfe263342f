package skein.fusion

import skein.units.*

/** Settings of the filter for one vehicle.
  *
  * @param acceleration process noise: spectral density of the vehicle's acceleration, m²/s³. A vehicle that
  *   accelerates with a (m/s²) for about τ (s) at a time has about a²τ
  * @param topSpeed standard deviation of the velocity before it was measured
  * @param history the greatest age of a measurement relative to the newest one
  * @param mostMeasurements limit of measurements kept
  */
final case class FusionSettings(
    acceleration: Double = 10,
    topSpeed: MetresPerSecond = MetresPerSecond(10),
    history: Span = Span.ofSeconds(2),
    mostMeasurements: Int = 256
):
  require(
    acceleration > 0 && topSpeed.value > 0 && history > Span.Zero && mostMeasurements > 0,
    s"fusion needs settings above zero: $this"
  )

/** Estimates one vehicle's state from measurements in any order. Each enters at its valid time, and all later
  * ones are processed again, so the estimate equals that of a filter that received all of them in order.
  * Measurements of one time are processed in the order of arrival.
  *
  * Immutable. An update costs one step of the filter for each measurement that is newer.
  */
final class Fusion private (
    settings: FusionSettings,
    before: Option[Belief], // all that is forgotten
    remembered: Vector[Fusion.Step]
):
  import Fusion.*

  /** The estimate after the newest measurement; none before the first. */
  def belief: Option[Belief] = remembered.lastOption.map(_.after).orElse(before)

  /** The estimate predicted for a moment at or after the newest measurement. */
  def at(later: Instant): Option[Belief] =
    belief.filter(_.at <= later).map(_.carriedTo(later, settings.acceleration))

  /** The filter with one more measurement. None if the measurement is older than all that are kept. */
  def including(measured: Measurement): Option[Fusion] =
    val isTooOld = before.exists(_.at > measured.validAt) ||
      belief.exists(_.at.since(measured.validAt) > settings.history)
    Option.unless(isTooOld):
      val (older, newer) =
        remembered.splitAt(remembered.lastIndexWhere(_.measured.validAt <= measured.validAt) + 1)
      val replayed = (measured +: newer.map(_.measured)).foldLeft(older): (steps, next) =>
        steps :+ Step(next, step(steps.lastOption.map(_.after).orElse(before), next))
      val oldest = replayed.last.measured.validAt - settings.history
      val kept   = replayed.dropWhile(_.measured.validAt < oldest).takeRight(settings.mostMeasurements)
      val gone   = replayed.dropRight(kept.size).lastOption.map(_.after)
      new Fusion(settings, gone.orElse(before), kept)

  private def step(last: Option[Belief], measured: Measurement): Belief = last match
    case Some(belief) => belief.carriedTo(measured.validAt, settings.acceleration).joined(measured)
    case None         =>
      val first =
        Belief.first(measured.validAt, measured.positionNed, measured.covariance, settings.topSpeed.value)
      measured.velocity.fold(first)(known =>
        first.copy(velocityNed = known.ned, velocity = known.covariance)
      )

object Fusion:
  def apply(settings: FusionSettings): Fusion = new Fusion(settings, None, Vector.empty)

  private final case class Step(measured: Measurement, after: Belief)
