package skein.fusion

import skein.units.*

/** Settings of the filter for one vehicle.
  *
  * @param acceleration process noise: spectral density of the vehicle's acceleration, m²/s³. It is about a²τ
  *   for a vehicle that accelerates with a (m/s²) for about τ (s) at a time
  * @param topSpeed standard deviation of the velocity before its first measurement
  * @param history maximum age of a stored measurement, relative to the newest
  * @param mostMeasurements maximum number of stored measurements
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

/** Estimates one vehicle's state from measurements in any order. Each is applied at its valid time, and all
  * later ones are then processed again. So the estimate equals that of a filter that received all
  * measurements in order. Measurements of equal times are processed in the order of arrival.
  *
  * Immutable. An update costs one step of the filter per newer measurement.
  */
final class Fusion private (
    settings: FusionSettings,
    before: Option[Belief], // all that is forgotten
    remembered: Vector[Fusion.Step]
):
  import Fusion.*

  /** The estimate after the newest measurement; None before the first. */
  def belief: Option[Belief] = remembered.lastOption.map(_.after).orElse(before)

  /** The estimate predicted for a time that is not before the newest measurement. */
  def at(later: Instant): Option[Belief] =
    belief.filter(_.at <= later).map(_.carriedTo(later, settings.acceleration))

  /** The filter with one more measurement; None if it is older than the last forgotten one, or by more than
    * `history` than the newest.
    */
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
