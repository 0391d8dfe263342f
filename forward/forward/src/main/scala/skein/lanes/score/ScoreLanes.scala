package skein.lanes.score

import skein.formula.{Angles, Evaluation, Formula, Node, Op, Trace, Untraceable}
import skein.lanes.timetable.OwnEnds
import skein.policy.PolicyInput
import skein.scenario.{EndFormula, OwnEnd, Positions, Quantity, Reduction}
import skein.simd.{BoundFunction, Forms, Sources}
import skein.units.Expect

/** Scores flights in many worlds with SIMD. The quantities, compiled from [[Quantity.of]], and their
  * reductions are one function: from the accumulators of each world and a view it computes their next values.
  * Flights of one form differ only in parameter values. If the scenario has an end of its own, another
  * function computes when each world ended; the accumulators of a world that has ended stay unchanged.
  */
private[lanes] final class ScoreLanes private (
    quantities: Vector[Formula],
    val judged: Vector[Judged],
    val count: Int,
    end: Option[EndFormula]
):
  import ScoreLanes.*

  private val trace   = Trace()
  private val sources = Sources[Source]()

  /** What an input of the compiled functions stands for. */
  def source(input: Int): Source = sources(input)

  private def nodeOf(source: Source): Node = trace.input(sources.inputOf(source))

  /** The formulas of the quantities, then that of the end. */
  private val all = quantities ++ end.map(_.formula)

  /** Number of formulas with parameters: the quantities, and the end if there is one. */
  def formulas: Int = all.size

  private val angles: Vector[Angles] = all.zipWithIndex.map: (formula, number) =>
    Angles(
      formula.trace,
      trace,
      if number < judged.size then ofPositions else ofEnd,
      _ => None,
      parameter => nodeOf(Source.Parameter(number, parameter))
    )

  /** The node for an input of a quantity's formula. */
  private def ofPositions(input: Int): Node =
    if input == 3 * count then trace.param(Time) else position(input % count, input / count)

  private def position(vehicle: Int, axis: Int): Node =
    nodeOf(if axis < 2 then Source.Reading(vehicle, axis) else Source.Altitude(vehicle))

  /** Whether a quantity depends on the time. */
  val asksTime: Boolean = quantities.exists(each =>
    Trace.needed(each.outputs.map(_._2)).exists(node => node.op == Op.Input && node.index == 3 * count)
  )

  /** The node for an input of the end's formula. */
  private def ofEnd(input: Int): Node = end.get.inputs(input) match
    case PolicyInput.Position(vehicle, axis) => position(vehicle, axis)
    case PolicyInput.Velocity(vehicle, axis) => nodeOf(Source.Velocity(vehicle, axis))
    case PolicyInput.Age(vehicle)            => nodeOf(Source.Age(vehicle))
    case _                                   => nodeOf(Source.Since)

  def hasEnd: Boolean = end.isDefined

  /** Offset of each score's accumulators; the last entry is their total number. If there is an end, these are
    * followed by the time at which the world ended, s, and by the number of values of each score.
    */
  val places: Vector[Int] = judged.map(initially(_).size).scanLeft(0)(_ + _)

  private val endedAt = places.last

  private def countOf(number: Int) = endedAt + 1 + number

  /** Index of the number of a score's values in each world; None if worlds do not end and all have an equal
    * number.
    */
  def counted(number: Int): Option[Int] = Option.when(hasEnd)(countOf(number))

  /** The initial values of the accumulators, by index. */
  val initial: Vector[Float] = judged.flatMap(initially) ++
    Vector.from(Option.when(hasEnd)(Float.PositiveInfinity +: judged.map(_ => 0f))).flatten

  private def kept(place: Int): Node = nodeOf(Source.Kept(place))

  private def formulaOf(number: Int): Node = angles(number).convert(all(number).outputs(0)._2)

  /** By score, the indices of its accumulators and their next values, the last one first: a long function is
    * split, and its first part has written its outputs when the second reads.
    */
  private val successors: Vector[Vector[(Int, Node)]] = judged.indices.toVector.map: number =>
    val own = successorsOf(number, formulaOf(number), each => kept(places(number) + each)).zipWithIndex.map:
      (next, each) => (places(number) + each, next)
    .reverse
    if !hasEnd then own
    else
      val isOver  = trace.lt(kept(endedAt), trace.param(Time))
      val counted = (countOf(number), trace.add(kept(countOf(number)), trace.const(1)))
      (own :+ counted).map((place, next) => (place, trace.where(isOver, kept(place), next)))

  /** Computes when each world ended; None if all last for the whole duration. */
  val ending: Option[Ending] = end.map: _ =>
    val goesOn = trace.equal(formulaOf(judged.size), trace.const(0))
    val now    = trace.where(goesOn, trace.const(Double.PositiveInfinity), nodeOf(Source.Now))
    Ending(endedAt, BoundFunction.of(Vector(trace.binary(Op.Min, kept(endedAt), now))))

  /** The kind of inputs on which the end depends. */
  val endsBy: OwnEnds =
    if end.isEmpty then OwnEnds.None
    else if asks({ case _: Source.Age | Source.Since => true }) then OwnEnds.ByTime
    else OwnEnds.ByPlace

  /** Whether the end depends on velocities of readings. */
  def needsVelocity: Boolean = asks({ case _: Source.Velocity => true })

  /** Whether the end depends on ages of readings. */
  def needsAges: Boolean = asks({ case _: Source.Age => true })

  /** Whether the end depends on the time since the first decision. */
  val asksSince: Boolean = asks({ case Source.Since => true })

  private def asks(what: PartialFunction[Source, Boolean]): Boolean =
    ending.exists(_.function.inputs.exists(input => what.isDefinedAt(source(input))))

  /** The next values of the accumulators. Each overwrites its predecessor, which only those behind it read,
    * and these do not depend on it.
    *
    * @param value the quantity's present value
    */
  private def successorsOf(number: Int, value: Node, kept: Int => Node): Vector[Node] =
    val own        = trace.param(ownParameter(number))
    val time       = trace.param(Time)
    def isPositive = trace.lt(trace.const(0), value)
    def never      = trace.const(Double.PositiveInfinity)
    judged(number).reduction match
      case Reduction.Least => Vector(trace.binary(Op.Min, kept(0), value))
      case Reduction.Most  => Vector(trace.binary(Op.Max, kept(0), value))
      case Reduction.Mean  => Vector(trace.add(kept(0), value))
      case Reduction.Rms   => Vector(trace.add(kept(0), trace.mul(value, value)))
      case Reduction.Sd    => // Welford's mean and sum of squares: Technometrics 4 (1962), 419.
        val off  = trace.sub(value, kept(0))
        val mean = trace.add(kept(0), trace.mul(off, own))
        Vector(mean, trace.add(kept(1), trace.mul(off, trace.sub(value, mean))))
      case Reduction.LeastAt =>
        Vector(trace.binary(Op.Min, kept(0), value), trace.where(trace.lt(value, kept(0)), time, kept(1)))
      case Reduction.MostAt =>
        Vector(trace.binary(Op.Max, kept(0), value), trace.where(trace.lt(kept(0), value), time, kept(1)))
      case Reduction.TimePositive =>
        Vector(trace.add(kept(0), trace.where(isPositive, trace.const(1), trace.const(0))))
      case Reduction.FirstPositive =>
        Vector(trace.binary(Op.Min, kept(0), trace.where(isPositive, time, never)))
      case Reduction.StaysPositive =>
        Vector(trace.where(isPositive, trace.binary(Op.Min, kept(0), time), never))
      case Reduction.Entries =>
        val (no, yes) = (trace.const(0), trace.const(1))
        Vector(
          trace.where(isPositive, yes, no),
          trace.add(kept(1), trace.where(isPositive, trace.sub(yes, kept(0)), no))
        )
      case OfMoment.FirstWithin(_) =>
        Vector(trace.binary(Op.Min, kept(0), trace.where(trace.le(value, own), time, never)))
      case OfMoment.Newest => Vector(value)

  private val derived = angles.map(_.derived)
  private val numbers = derived.map(Evaluation(_))

  private def startsS(number: Int): Double = if hasEnd then 0 else judged(number).fromS

  /** The scores that restart at their time in worlds that have not ended by then, in the order of these
    * times: of a shorter flight, all of it counts.
    */
  val renewed: Vector[Int] =
    judged.indices.toVector.filter(number => startsS(number) < judged(number).fromS).sortBy(judged(_).fromS)

  /** The functions to use, each from its time until that of the next. */
  val stages: Vector[Stage] = judged.indices.map(startsS).distinct.sorted.toVector.map: fromS =>
    val numbers = judged.indices.filter(startsS(_) <= fromS).toVector
    Stage(
      fromS,
      numbers,
      numbers.flatMap(successors(_).map(_._1)),
      BoundFunction.of(numbers.flatMap(successors(_).map(_._2)))
    )

  /** Whether a score needs the weight of a new value, 1 over the count so far. */
  def hasShare(number: Int): Boolean = judged(number).reduction == Reduction.Sd

  /** Number of parameters that distinguish a quantity from others of its form. */
  def parameters(number: Int): Int = derived(number).size

  /** The parameters of each quantity, then those of the end, if there is one. */
  def parametersOf(quantities: Vector[Judged], end: Option[OwnEnd]): Array[Array[Double]] =
    val of = quantities.map(_.quantity) ++ end.map(_.scenario)
    Array.tabulate(of.size): number =>
      numbers(number)(Array.emptyDoubleArray, all(number).parametersOf(of(number)))

  /** Whether these scores of this number of vehicles, with this end, have this form. */
  def fits(by: Vector[Judged], vehicles: Int, ends: Option[OwnEnd]): Boolean =
    vehicles == count && by.size == judged.size && ends.isDefined == hasEnd && by.indices.forall { number =>
      val (own, other) = (judged(number), by(number))
      own.copy(quantity = other.quantity) == other && all(number).fits(other.quantity)
    } && ends.forall(each => all.last.fits(each.scenario))

private[lanes] object ScoreLanes:
  /** Indices of the parameters that all worlds share: the time, s; then for each score a limit, or the weight
    * of the new value.
    */
  final val Time                     = 0
  def ownParameter(number: Int): Int = 1 + number

  /** @see [[ScoreLanes.source]]; `Now` is the time of a decision and `Since` the time from the first decision
    *   to it, s
    */
  enum Source:
    case Now, Since
    case Age(vehicle: Int)
    case Reading(vehicle: Int, field: Int)
    case Altitude(vehicle: Int)
    case Velocity(vehicle: Int, axis: Int)
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

  /** A time rounded to a microsecond, s: the difference of two floats may be just below a round number. */
  def microseconds(timeS: Float): Float = (math.round(timeS * 1e6) * 1e-6).toFloat

  /** The function that computes when each world ended, s: infinity until then.
    *
    * @param place index of the time among the accumulators
    */
  final case class Ending(place: Int, function: BoundFunction)

  private def initially(judged: Judged): Vector[Float] = judged.reduction match
    case Reduction.Least | OfMoment.FirstWithin(_)               => Vector(Float.PositiveInfinity)
    case Reduction.FirstPositive | Reduction.StaysPositive       => Vector(Float.PositiveInfinity)
    case Reduction.Most                                          => Vector(Float.NegativeInfinity)
    case Reduction.LeastAt                                       => Vector(Float.PositiveInfinity, Float.NaN)
    case Reduction.MostAt                                        => Vector(Float.NegativeInfinity, Float.NaN)
    case OfMoment.Newest                                         => Vector(Float.NaN)
    case Reduction.Sd | Reduction.Entries                        => Vector(0, 0)
    case Reduction.Mean | Reduction.Rms | Reduction.TimePositive => Vector(0)

  private type Scored = (Vector[Judged], Int, Option[OwnEnd])

  private val known = Forms[Scored, ScoreLanes]((form, of) => form.fits(of._1, of._2, of._3)):
    (judged, vehicles, end) =>
      for
        quantities <- Expect.each(judged): each =>
          formulaOf(each.quantity, vehicles).left.map(of("a quantity", _))
        ending <- Expect.each(end.toVector)(EndFormula.of(_, vehicles).left.map(of("its end", _)))
      yield ScoreLanes(quantities, judged, vehicles, ending.headOption)

  private def of(what: String, refused: Untraceable) =
    Untraceable(s"$what is no formula: ${refused.getMessage}")

  /** Compiles scores, once for each form. Left says why SIMD does not support them.
    *
    * @param end the condition by which the scenario ends before its duration
    */
  def of(
      judged: Vector[Judged],
      vehicles: Int,
      end: Option[OwnEnd] = None
  ): Either[Untraceable, ScoreLanes] = known((judged, vehicles, end))

  /** The final value of a score; NaN without values.
    *
    * @param kept its last accumulator
    * @param count number of values
    */
  def value(of: Judged, kept: Float, count: Int): Float = of.reduction match
    case Reduction.Rms | Reduction.Sd => math.sqrt(kept / count).toFloat
    case Reduction.Mean               => kept / count
    case _: Reduction if count == 0   => Float.NaN
    case Reduction.TimePositive       => (kept * of.everyS).toFloat
    case _                            => kept

  private def formulaOf(quantity: Quantity, vehicles: Int): Either[Untraceable, Formula] =
    // A user's quantity may have any name for its argument.
    val argument = quantity.getClass.getMethod("of", classOf[Positions]).getParameters.head.getName
    Formula.of(
      quantity,
      "of",
      Seq("northM", "eastM", "downM").map(field => s"$argument.$field" -> vehicles).toMap,
      Some(Seq(classOf[Positions]))
    )
