package skein.lanes.policy

import scala.collection.mutable
import skein.formula.{Angles, Evaluation, Formula, Node, Op, Trace, Untraceable}
import skein.policy.{TeamPolicy, TeamObservation}
import skein.simd.{BoundFunction, Forms}
import skein.units.Expect

/** How the policies of a team decide in many worlds at once, compiled from their methods
  * [[TeamPolicy.course]]. Teams of one form differ in numbers alone.
  *
  * What several vehicles compute of one view is computed once for all of them: of the bearings that each
  * pursuer wants to know, say.
  */
private[lanes] final class TeamLanes private (formulas: Vector[Formula]):
  import TeamLanes.*

  /** How many vehicles fly. */
  val count: Int = formulas.size

  private val view  = 4 * count
  private val trace = Trace(MostOperations)

  private val angles: Vector[Angles] = Vector.tabulate(count): self =>
    def own(number: Int) = trace.input(ownInput(self, number))
    Angles(
      formulas(self).trace,
      trace,
      input =>
        if input < view then trace.input(input)
        else if input == view then trace.binary(Op.Atan2, own(Own.Sin), own(Own.Cos))
        else own(Own.Elapsed),
      input => Option.when(input == view)((own(Own.Cos), own(Own.Sin))),
      number => own(Own.Parameters + number)
    )

  /** By vehicle: the velocity commanded, north and east, and the cosine and sine of its heading. */
  val outputs: Vector[Vector[Node]] = Vector.tabulate(count): self =>
    val Vector((_, headingRad), (_, speedMps)) = formulas(self).outputs: @unchecked
    val (cos, sin)                             = angles(self).cosSin(angles(self).factored(headingRad))
    val speed                                  = angles(self).convert(speedMps)
    Vector(trace.mul(speed, cos), trace.mul(speed, sin), cos, sin)

  private val derived = angles.map(_.derived)
  private val numbers = derived.map(Evaluation(_))

  private val common = Common.of(outputs, view)

  /** What is computed once of a view; there may be nothing. */
  val shared: BoundFunction = BoundFunction.of(common.nodes)

  /** By vehicle: what it computes besides. */
  val functions: Vector[BoundFunction] =
    outputs.map(each =>
      BoundFunction.of(common.without(trace, each, number => trace.input(sharedInput(number))))
    )

  /** A vehicle and what of its reading an input is, 0 to 3: position north and east, velocity north and east.
    */
  def reading(input: Int): Option[(Int, Int)] =
    Option.when(input < view)((input % count, input / count))

  /** What another input is. */
  def source(input: Int): Source =
    if input >= FirstShared then Source.Shared(input - FirstShared)
    else
      (input - view) % Stride match
        case Own.Cos     => Source.Cos
        case Own.Sin     => Source.Sin
        case Own.Elapsed => Source.Elapsed
        case number      => Source.Parameter(number - Own.Parameters)

  /** Whether anybody looks at velocities. */
  val needsVelocity: Boolean =
    (shared +: functions).exists(_.inputs.exists(reading(_).exists((_, field) => field >= 2)))

  /** How many numbers a vehicle's policy differs by from another of its form. */
  def parameters(self: Int): Int = derived(self).size

  def parametersOf(self: Int, policy: TeamPolicy): Array[Double] =
    numbers(self)(Array.emptyDoubleArray, formulas(self).parametersOf(policy))

  /** Whether a team is of this form. */
  def fits(policies: Vector[TeamPolicy]): Boolean =
    policies.size == count && policies.indices.forall(self => formulas(self).fits(policies(self)))

  private def ownInput(self: Int, number: Int) = view + self * Stride + number

private[lanes] object TeamLanes:
  /** Inputs that each vehicle has for itself. */
  private object Own:
    final val Cos        = 0
    final val Sin        = 1
    final val Elapsed    = 2
    final val Parameters = 3

  /** More parameters than a policy of as many operations as a trace holds may have. */
  private final val Stride      = 1 << 18
  private final val FirstShared = 1 << 30

  /** Of all vehicles together. */
  private final val MostOperations = 2_000_000

  private def sharedInput(number: Int) = FirstShared + number

  enum Source:
    case Cos, Sin, Elapsed
    case Parameter(number: Int)
    case Shared(number: Int)

  private val known = Forms[Vector[TeamPolicy], TeamLanes](_.fits(_)): policies =>
    Expect
      .each(policies.zipWithIndex)((policy, self) => formulaOf(policy, self, policies.size))
      .map(TeamLanes(_))

  /** How a team flies by lanes, or why it does not. Compiled once for each form. */
  def of(policies: Vector[TeamPolicy]): Either[Untraceable, TeamLanes] = known(policies)

  /** What a policy computes as one of so many. */
  def formulaOf(policy: TeamPolicy, self: Int, count: Int): Either[Untraceable, Formula] = Formula.of(
    policy,
    "course",
    Seq("northM", "eastM", "northMps", "eastMps").map(field => s"seen.$field" -> count).toMap,
    Some(Seq(classOf[TeamObservation])),
    Map("seen.self" -> self)
  )

/** What several expressions have in common, of all that depends on the first inputs alone.
  *
  * @param nodes what is worth to be computed once
  */
private final class Common private (val nodes: Vector[Node]):
  private val numbers = nodes.zipWithIndex.toMap

  /** The expressions with inputs in the place of what they have in common. */
  def without(trace: Trace, outputs: Vector[Node], input: Int => Node): Vector[Node] =
    Trace.replaced(outputs, trace)(numbers.get(_).map(input))

private object Common:
  /** Fewer operations are done again sooner than fetched. */
  private val LeastOperations = 4

  def of(expressions: Vector[Vector[Node]], inputs: Int): Common =
    val needed = expressions.map(Trace.needed)
    val users  = mutable.HashMap.empty[Node, Int].withDefaultValue(0)
    for each <- needed; node <- each do users(node) += 1
    val isOfInputs = mutable.HashMap.empty[Node, Boolean]
    for each <- needed; node <- each do
      isOfInputs(node) = node.op match
        case Op.Input             => node.index < inputs
        case Op.Const | Op.Always => true
        case _                    => node.args.forall(isOfInputs)
    def isCommon(node: Node) = users(node) > 1 && node.args.nonEmpty && isOfInputs(node)
    def isWorth(node: Node)  =
      val seen                        = mutable.HashSet.empty[Node]
      def isDear(part: Node): Boolean =
        part.args.nonEmpty && seen.add(part) &&
          (seen.size >= LeastOperations || part.op.isDear || part.args.exists(isDear))
      isDear(node)
    // Masks are not laid by, but what they compare.
    def numbersOf(node: Node): Vector[Node] =
      if node.op.isCondition then node.args.flatMap(numbersOf) else Vector(node)
    val chosen =
      for
        each <- needed
        node <- each
        if !isCommon(node)
        arg <- node.args
        if isCommon(arg)
        number <- numbersOf(arg)
        if isCommon(number) && isWorth(number)
      yield number
    val whole = expressions.flatten.filter(node => isCommon(node) && !node.op.isCondition)
    Common((chosen ++ whole).distinct)
