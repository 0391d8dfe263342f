package skein.optimise

import skein.forward.Rollout
import skein.lanes.score.{Effort, Judged, OfMoment}
import skein.scenario.{Measure, Reduction, Separation, Window}

/** A value of a flight that an objective may contain. */
trait Term:
  /** The term's name as users write it in an objective. */
  def key: String

  def unit: String

  /** Number of scores that forward simulation computes for this term; 0 if only a complete flight has it. */
  def size: Int = 1

  def judged(durationS: Double, periodS: Double): Vector[Judged | Effort]

  /** The term's value in an episode; NaN if it has none.
    *
    * @param score the term's scores by their index in [[judged]]
    */
  def value(score: Int => Float, durationS: Double): Double

/** A measure of a scenario; its key is that of the measure, such as `off-ring`. */
final case class ScenarioTerm(measure: Measure) extends Term:
  def key: String  = ScenarioTerm.keyOf(measure)
  def unit: String = measure.unit

  override def size: Int = measure.parts.size

  def judged(durationS: Double, periodS: Double): Vector[Judged] = measure.parts.map: by =>
    val fromS = by.over match
      case Window.Whole          => 0
      case Window.After(seconds) => seconds
      case Window.Last(seconds)  => durationS - math.floor(seconds / periodS + 1e-9) * periodS
    Judged(by.quantity, by.reduction, fromS, periodS)

  private val isReduction = measure.reduced.nonEmpty
  private val mayBeNever  = ScenarioTerm.mayBeNever(measure)

  def value(score: Int => Float, durationS: Double): Double =
    if mayBeNever then durationS.min(score(0))
    else if isReduction then score(0)
    else measure.of(Vector.tabulate(size)(score(_).toDouble)).getOrElse(Double.NaN)

object ScenarioTerm:
  /** The value of a time that is never reached: the episode's duration; None if the measure is no such time.
    */
  def never(measure: Measure, durationS: Double): Option[Double] =
    Option.when(mayBeNever(measure))(durationS)

  private def mayBeNever(measure: Measure) = measure.reduced.exists(_.reduction.mayBeNever)

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

  def judged(durationS: Double, periodS: Double): Vector[Judged] = Vector(this match
    case Last10s              => Judged(Separation, Reduction.Mean, Rollout.last10sFromS(durationS, periodS))
    case Mean                 => Judged(Separation, Reduction.Mean, 0)
    case Min                  => Judged(Separation, Reduction.Least, 0)
    case Capture(radiusM, _)  => Judged(Separation, OfMoment.FirstWithin(radiusM), 0)
    case CaptureTime(radiusM) => Judged(Separation, OfMoment.FirstWithin(radiusM), 0))

  def value(score: Int => Float, durationS: Double): Double = this match
    // The time of a score is a Float, and a capture exactly at the limit counts.
    case Capture(_, withinS) => if score(0) <= withinS.toFloat then 1.0 else 0.0
    case CaptureTime(_)      => durationS.min(score(0))
    case _                   => score(0)

/** The control effort of a vehicle, by its index in the team. */
final case class EffortTerm(vehicle: Int) extends Term:
  def key: String                                                = "effort"
  def unit: String                                               = "rad"
  def judged(durationS: Double, periodS: Double): Vector[Effort] = Vector(Effort(vehicle))
  def value(score: Int => Float, durationS: Double): Double      = score(0)
