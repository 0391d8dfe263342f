package skein.lanes.score

import skein.formula.{Angles, Evaluation, Formula, Node, Op, Trace, Untraceable}
import skein.scenario.{Positions, Quantity, Reduction, Separation}
import skein.simd.{BoundFunction, Forms}
import skein.units.Expect

/** Scores flights in many worlds by SIMD. The quantities, compiled from [[Quantity.of]], and their reductions
  * are one function: from the accumulators of each world and a view it computes their next values. Flights of
  * one form differ only in parameter values.
  */
private[lanes] final class ScoreLanes private (
    formulas: Vector[Formula],
    val judged: Vector[Judged],
    val count: Int
):
  import ScoreLanes.*

  private val trace = Trace()

  private val angles: Vector[Angles] = formulas.zipWithIndex.map: (formula, number) =>
    Angles(
      formula.trace,
      trace,
      trace.input,
      _ => None,
      parameter => trace.input(FirstParameter + number * Stride + parameter)
    )

  /** The initial values of the accumulators, by index. */
  val initial: Vector[Float] = judged.flatMap(initially)

  /** Offset of each score's accumulators; the last entry is their total number. */
  val places: Vector[Int] = judged.map(initially(_).size).scanLeft(0)(_ + _)

  private val successors: Vector[Vector[Node]] = judged.indices.toVector.map: number =>
    successorsOf(
      number,
      angles(number).convert(formulas(number).outputs(0)._2),
      kept => trace.input(FirstKept + places(number) + kept)
    )

  /** The next values of the accumulators. Each may overwrite its predecessor, which no other expression
    * reads.
    *
    * @param value the quantity's present value
    */
  private def successorsOf(number: Int, value: Node, kept: Int => Node): Vector[Node] =
    val own = trace.param(ownParameter(number))
    judged(number).reduction match
      case Reduction.Least => Vector(trace.binary(Op.Min, kept(0), value))
      case Reduction.Most  => Vector(trace.binary(Op.Max, kept(0), value))
      case Reduction.Mean  => Vector(trace.add(kept(0), value))
      case Reduction.Rms   => Vector(trace.add(kept(0), trace.mul(value, value)))
      case Reduction.Sd    => // Welford's mean and sum of squares: Technometrics 4 (1962), 419.
        val off  = trace.sub(value, kept(0))
        val mean = trace.add(kept(0), trace.mul(off, own))
        Vector(mean, trace.add(kept(1), trace.mul(off, trace.sub(value, mean))))
      case OfMoment.FirstWithin(_) =>
        val now = trace.where(trace.le(value, own), trace.param(Time), trace.const(Double.PositiveInfinity))
        Vector(trace.binary(Op.Min, now, kept(0)))
      case OfMoment.Newest => Vector(value)

  private val derived = angles.map(_.derived)
  private val numbers = derived.map(Evaluation(_))

  /** The functions to use, each from its time until that of the next. */
  val stages: Vector[Stage] = judged.map(_.fromS).distinct.sorted.map: fromS =>
    val numbers = judged.indices.filter(judged(_).fromS <= fromS).toVector
    Stage(
      fromS,
      numbers,
      numbers.flatMap(number => successors(number).indices.map(places(number) + _)),
      BoundFunction.of(numbers.flatMap(successors))
    )

  /** The source of a function's input: a reading, an altitude, a parameter or an accumulator. */
  def source(input: Int): Source =
    if input < 2 * count then Source.Reading(input % count, input / count)
    else if input < FirstParameter then Source.Altitude(input - 2 * count)
    else if input < FirstKept then
      Source.Parameter((input - FirstParameter) / Stride, (input - FirstParameter) % Stride)
    else Source.Kept(input - FirstKept)

  /** Whether a score needs the weight of a new value, 1 over the count so far. */
  def hasShare(number: Int): Boolean = judged(number).reduction == Reduction.Sd

  /** Number of parameters that distinguish a quantity from others of its form. */
  def parameters(number: Int): Int = derived(number).size

  def parametersOf(number: Int, quantity: Quantity): Array[Double] =
    numbers(number)(Array.emptyDoubleArray, formulas(number).parametersOf(quantity))

  /** Whether these scores of this number of vehicles have this form. */
  def fits(by: Vector[Judged], vehicles: Int): Boolean =
    vehicles == count && by.size == judged.size && by.indices.forall: number =>
      val (own, other) = (judged(number), by(number))
      own.reduction == other.reduction && own.fromS == other.fromS && formulas(number).fits(other.quantity)

private[lanes] object ScoreLanes:
  private final val FirstParameter = 1 << 20
  private final val Stride         = 1 << 18
  private final val FirstKept      = 1 << 30

  /** Indices of the parameters that all worlds share: the time, s; then for each score a limit, or the weight
    * of the new value.
    */
  final val Time                     = 0
  def ownParameter(number: Int): Int = 1 + number

  enum Source:
    case Reading(vehicle: Int, field: Int)
    case Altitude(vehicle: Int)
    case Parameter(number: Int, parameter: Int)
    case Kept(place: Int)

  /** The function to use from a time on.
    *
    * @param judged indices of the scores that are updated from then on
    * @param places index of the accumulator that each output updates
    */
  final case class Stage(fromS: Double, judged: Vector[Int], places: Vector[Int], function: BoundFunction):
    /** Samples later than this are scored (exclusive bound). */
    def afterS: Float =
      val (exact, near) = (Judged.afterS(fromS), Judged.afterS(fromS).toFloat)
      if near > exact then Math.nextDown(near) else near

  private def initially(judged: Judged): Vector[Float] = judged.reduction match
    case Reduction.Least | OfMoment.FirstWithin(_) => Vector(Float.PositiveInfinity)
    case Reduction.Most                            => Vector(Float.NegativeInfinity)
    case OfMoment.Newest                           => Vector(Float.NaN)
    case Reduction.Sd                              => Vector(0, 0)
    case Reduction.Mean | Reduction.Rms            => Vector(0)

  private val known = Forms[(Vector[Judged], Int), ScoreLanes]((form, of) => form.fits(of._1, of._2)):
    (judged, vehicles) =>
      Expect.each(judged)(each => formulaOf(each.quantity, vehicles)).map(ScoreLanes(_, judged, vehicles))

  /** Compiles scores, once for each form. Left states why SIMD does not support them. */
  def of(judged: Vector[Judged], vehicles: Int): Either[Untraceable, ScoreLanes] = known((judged, vehicles))

  /** The final value of a score; NaN without values.
    *
    * @param kept its last accumulator
    * @param count number of values
    */
  def value(reduction: Reduction | OfMoment, kept: Float, count: Int): Float = reduction match
    case Reduction.Rms | Reduction.Sd                   => math.sqrt(kept / count).toFloat
    case Reduction.Mean                                 => kept / count
    case Reduction.Least | Reduction.Most if count == 0 => Float.NaN
    case _                                              => kept

  /** Scores the distance between two vehicles.
    *
    * @param by reductions of the distance, each with the time from which values count, s
    */
  def ofDistance(by: (Reduction | OfMoment, Double)*): ScoreLanes =
    of(by.toVector.map(Judged(Separation, _, _)), 2).fold(throw _, identity)

  private def formulaOf(quantity: Quantity, vehicles: Int): Either[Untraceable, Formula] =
    // A user's quantity may have any name for its argument.
    val argument = quantity.getClass.getMethod("of", classOf[Positions]).getParameters.head.getName
    Formula.of(
      quantity,
      "of",
      Seq("northM", "eastM", "downM").map(field => s"$argument.$field" -> vehicles).toMap,
      Some(Seq(classOf[Positions]))
    )
