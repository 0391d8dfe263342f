package skein.optimise

import skein.lanes.{DuelNumber, DuelOutcomes}
import skein.policy.Role
import skein.units.Expect

/** A measure of an episode, by the name that users give. */
enum DuelMeasure:
  case Last10s

  case Mean

  case Min

  /** Sum of the changes of the judged vehicle's commanded heading, rad. */
  case Effort

  /** 1 if the distance was at most `radiusM` within the first `withinS` of the episode, else 0: its mean is
    * the probability of capture.
    */
  case Capture(radiusM: Double, withinS: Double)

  /** First time at which the distance was at most `radiusM`, s; the episode's duration if it never was. */
  case CaptureTime(radiusM: Double)

  def text: String = this match
    case Last10s                   => "last10s"
    case Mean                      => "mean"
    case Min                       => "min"
    case Effort                    => "effort"
    case Capture(radiusM, withinS) => s"capture($radiusM, $withinS)"
    case CaptureTime(radiusM)      => s"captureTime($radiusM)"

  /** The number of an episode's outcome that it needs.
    *
    * @param role of the judged vehicle
    */
  def number(role: Role): DuelNumber = this match
    case Last10s                        => DuelNumber.MeanLast10s
    case Mean                           => DuelNumber.MeanDistance
    case Min                            => DuelNumber.MinDistance
    case Capture(_, _) | CaptureTime(_) => DuelNumber.Capture
    case Effort if role == Role.Pursuer => DuelNumber.PursuerEffort
    case Effort                         => DuelNumber.EvaderEffort

  def unit: String = this match
    case Last10s | Mean | Min => "m"
    case Effort               => "rad"
    case Capture(_, _)        => ""
    case CaptureTime(_)       => "s"

  /** The radius that counts as a capture, for the measures that have one. */
  def captureRadiusM: Option[Double] = this match
    case Capture(radiusM, _)  => Some(radiusM)
    case CaptureTime(radiusM) => Some(radiusM)
    case _                    => None

/** The objective of a search for a duel's policy.
  *
  * @param terms weight and measure; all measures of captures have one radius
  */
final case class Objective(terms: Vector[(Double, DuelMeasure)], direction: Direction)
    extends SummedMeasures[DuelMeasure](_.text, _.unit):
  require(terms.nonEmpty, "an objective needs at least one term")
  require(
    terms.flatMap((_, measure) => measure.captureRadiusM).distinct.size <= 1,
    "all capture measures of an objective must name the same radius"
  )

  /** The radius within which an episode counts as a capture, m; 0 if no measure needs one. */
  def captureRadiusM: Double = terms.flatMap((_, measure) => measure.captureRadiusM).headOption.getOrElse(0.0)

  /** The numbers of an episode that it needs.
    *
    * @param role whose effort counts
    */
  def asked(role: Role): Set[DuelNumber] = terms.map((_, measure) => measure.number(role)).toSet

  /** The value in one episode.
    *
    * @param role whose effort counts
    */
  def value(outcomes: DuelOutcomes, world: Int, role: Role, durationS: Double): Double =
    var sum = 0.0
    for (weight, measure) <- terms do
      val told         = outcomes(measure.number(role))(world)
      val came: Double = measure match
        // The time of a score is known as a Float alone: a capture exactly then counts.
        case DuelMeasure.Capture(_, withinS) => if told <= withinS.toFloat then 1.0 else 0.0
        case DuelMeasure.CaptureTime(_)      => told.toDouble.min(durationS)
        case _                               => told
      sum += weight * came
    sum

object Objective:
  private val Forms =
    "last10s, mean, min, effort, capture(RADIUS_M, WITHIN_S), captureTime(RADIUS_M)"

  /** Reads a measure's name, or a sum such as `0.7*last10s + 0.3*effort`, with an optional `minimise` or
    * `maximise` before it. The default minimises a sum, and takes the role's direction for a single measure.
    *
    * @return Left states what was expected, what was given, and at which character
    */
  def parse(text: String, role: Role): Either[String, Objective] =
    for
      sum <- WeightedSum.parse(text, Forms)(measureOf)
      read = sum.terms
      _ <- Expect.that(read.flatMap((_, measure) => measure.captureRadiusM).distinct.size <= 1):
        s"objective '$text': expected one capture radius, came " +
          s"${read.flatMap((_, m) => m.captureRadiusM).distinct.mkString(" and ")} m"
    yield Objective(read, sum.stated.getOrElse(naturally(read, role)))

  private def naturally(terms: Vector[(Double, DuelMeasure)], role: Role): Direction = terms match
    case Vector((1.0, measure)) =>
      val pursuerWantsMore = measure match
        case DuelMeasure.Capture(_, _) => true
        case _                         => false
      measure match
        case DuelMeasure.Effort => Direction.Minimise
        case _                  =>
          if pursuerWantsMore == (role == Role.Pursuer) then Direction.Maximise else Direction.Minimise
    case _ => Direction.Minimise

  private def measureOf(name: String, arguments: Option[String]): Either[String, DuelMeasure] =
    val numbers =
      arguments.map(_.split(',').toVector.map(_.trim.toDoubleOption.filter(x => x > 0 && x < 1e6)))
    (name, numbers) match
      case ("last10s", None)                                       => Right(DuelMeasure.Last10s)
      case ("mean", None)                                          => Right(DuelMeasure.Mean)
      case ("min", None)                                           => Right(DuelMeasure.Min)
      case ("effort", None)                                        => Right(DuelMeasure.Effort)
      case ("capture", Some(Vector(Some(radiusM), Some(withinS)))) =>
        Right(DuelMeasure.Capture(radiusM, withinS))
      case ("captureTime", Some(Vector(Some(radiusM)))) => Right(DuelMeasure.CaptureTime(radiusM))
      case ("capture", Some(Vector(_, _))) | ("captureTime", Some(Vector(_))) =>
        Left(
          "expected capture(RADIUS_M, WITHIN_S) or captureTime(RADIUS_M) with numbers above 0 and below a million, " +
            s"came '$name(${arguments.get})'"
        )
      case _ =>
        Left(s"expected one of $Forms, came '$name${arguments.fold("")(a => s"($a)")}'")
