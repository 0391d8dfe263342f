package skein.optimise

import skein.forward.Rollout
import skein.lanes.score.{Effort, Judged, OfMoment}
import skein.scenario.{Measure, Reduction, Separation, Window}

/** A value of a flight that an objective may contain. */
trait Term:
  /** The term's name as users write it in an objective. */
  def key: String

  def unit: String

  /** The score that forward simulation computes for this term; None if only a complete flight has it. */
  def judged(durationS: Double, periodS: Double): Option[Judged | Effort]

  /** The term's value in an episode.
    *
    * @param computed the score described by [[judged]]
    */
  def value(computed: Float, durationS: Double): Double

/** A measure of a scenario; its key is that of the measure, such as `off-ring`. */
final case class ScenarioTerm(measure: Measure) extends Term:
  def key: String  = ScenarioTerm.keyOf(measure)
  def unit: String = measure.unit

  def judged(durationS: Double, periodS: Double): Option[Judged] = measure.reduced.map: by =>
    val fromS = by.over match
      case Window.Whole          => 0
      case Window.After(seconds) => seconds
      case Window.Last(seconds)  => durationS - math.floor(seconds / periodS + 1e-9) * periodS
    Judged(by.quantity, by.reduction, fromS, periodS)

  def value(computed: Float, durationS: Double): Double =
    ScenarioTerm.never(measure, durationS).fold(computed.toDouble)(computed.toDouble.min)

object ScenarioTerm:
  /** The value of a time that is never reached: the episode's duration; None if the measure is no such time.
    */
  def never(measure: Measure, durationS: Double): Option[Double] =
    Option.when(measure.reduced.exists(_.reduction.mayBeNever))(durationS)

  def keyOf(measure: Measure): String = measure.name.replace(' ', '-')

/** A value of a duel that depends on the distance between the two vehicles. */
enum DistanceTerm(val key: String, val unit: String) extends Term:
  case Last10s extends DistanceTerm("last10s", "m")

  case Mean extends DistanceTerm("mean", "m")

  case Min extends DistanceTerm("min", "m")

  /** 1 if the distance was at most `radiusM` within the first `withinS` of the episode, else 0. The mean over
    * episodes is the probability of capture.
    */
  case Capture(radiusM: Double, withinS: Double) extends DistanceTerm(s"capture($radiusM, $withinS)", "")

  /** First time at which the distance was at most `radiusM`, s; the episode's duration if there is none. */
  case CaptureTime(radiusM: Double) extends DistanceTerm(s"captureTime($radiusM)", "s")

  def judged(durationS: Double, periodS: Double): Option[Judged] = Some(this match
    case Last10s              => Judged(Separation, Reduction.Mean, Rollout.last10sFromS(durationS, periodS))
    case Mean                 => Judged(Separation, Reduction.Mean, 0)
    case Min                  => Judged(Separation, Reduction.Least, 0)
    case Capture(radiusM, _)  => Judged(Separation, OfMoment.FirstWithin(radiusM), 0)
    case CaptureTime(radiusM) => Judged(Separation, OfMoment.FirstWithin(radiusM), 0))

  def value(computed: Float, durationS: Double): Double = this match
    // The time of a score is a Float, and a capture exactly at the limit counts.
    case Capture(_, withinS) => if computed <= withinS.toFloat then 1.0 else 0.0
    case CaptureTime(_)      => computed.toDouble.min(durationS)
    case _                   => computed

/** The control effort of a vehicle, by its index in the team. */
final case class EffortTerm(vehicle: Int) extends Term:
  def key: String                                                = "effort"
  def unit: String                                               = "rad"
  def judged(durationS: Double, periodS: Double): Option[Effort] = Some(Effort(vehicle))
  def value(computed: Float, durationS: Double): Double          = computed
