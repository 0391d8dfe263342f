package skein.lanes.policy

import skein.formula.{Angles, Evaluation, Node, Op, Trace, Untraceable}
import skein.lanes.policy.OpponentFormula.In as Seen
import skein.policy.{GraphPolicy, Policy, PolicyFormula}
import skein.simd.{Forms, LaneCompiler, LaneFunction, Recent}

/** The decision of policies of one form in many worlds with SIMD, compiled from the policy's own method;
  * [[OpponentFormula]] defines which policies have one. Policies of one form differ only in parameter values.
  */
private[skein] final class PolicyLanes private (formula: OpponentFormula):
  import PolicyLanes.*

  private val trace  = Trace()
  private val source = formula.trace
  private val own    = source.input(Seen.OwnHeading)

  /** The turn from the last heading, for a policy that decides by turning; otherwise its result is a
    * direction.
    */
  private lazy val turn: Option[Node] = turnOf(heading)

  private lazy val angles: Angles = Angles(
    source,
    trace,
    {
      case index if index <= Seen.Dvy        => trace.input(index)
      case Seen.OwnHeading if turn.isDefined => trace.input(In.Heading)
      case Seen.OwnHeading      => trace.binary(Op.Atan2, trace.input(In.OwnSin), trace.input(In.OwnCos))
      case Seen.OpponentHeading => trace.binary(Op.Atan2, trace.input(In.KnownSin), trace.input(In.KnownCos))
      case Seen.Elapsed         => trace.input(In.Elapsed)
      case Seen.OwnAge          => trace.input(In.OwnAge)
      case Seen.OpponentAge     => trace.input(In.OpponentAge)
      case remembered           => trace.input(In.Memory + remembered - Seen.Memory)
    },
    {
      case Seen.OwnHeading      => Some((trace.input(In.OwnCos), trace.input(In.OwnSin)))
      case Seen.OpponentHeading => Some((trace.input(In.KnownCos), trace.input(In.KnownSin)))
      case _                    => None
    },
    trace.param
  )

  private lazy val heading = angles.factored(formula.heading)

  val memories: Int = formula.memory.size

  /** Cosine and sine of the decided heading, its change, the next memory, and the heading itself if it is
    * kept.
    */
  val outputs: Vector[Node] =
    val remembered = formula.memory.map(angles.convert)
    turn match
      case Some(by) =>
        val change  = wrapped(angles.convert(by))
        val heading = wrapped(trace.add(trace.input(In.Heading), change))
        Vector(trace.unary(Op.Cos, heading), trace.unary(Op.Sin, heading), trace.unary(Op.Abs, change)) ++
          remembered :+ heading
      case None =>
        val (cos, sin) = angles.cosSin(heading)
        Vector(cos, sin, apart(cos, sin)) ++ remembered

  /** Whether it turns from the last commanded heading; then it outputs a heading in addition to its
    * direction.
    */
  val keepsHeading: Boolean = turn.isDefined

  /** Number of [[outputs]] before the memory. */
  val decided: Int = outputs.size - memories - (if keepsHeading then 1 else 0)

  private val needed = Trace.needed(outputs)

  val needsVelocity: Boolean = looksAt(Seen.Dvx) || looksAt(Seen.Dvy)

  val needsAges: Boolean = looksAt(In.OwnAge) || looksAt(In.OpponentAge)

  private def looksAt(input: Int) = needed.exists(node => node.op == Op.Input && node.index == input)

  private val derived = angles.derived

  /** Number of parameters by which it differs from others of its form. */
  def parameters: Int = derived.size

  /** Number of arrays that it reads. */
  def inputs: Int = In.Memory + memories

  /** Number of components of the memory up to the last one on which a decision depends. The others are only
    * observed from outside.
    */
  val remembered: Int =
    needed.iterator.filter(node => node.op == Op.Input && node.index >= In.Memory).map(
      _.index - In.Memory + 1
    )
      .maxOption.getOrElse(0)

  private def deciding(withEffort: Boolean) =
    val all = nodes(withEffort)
    all.patch(all.size - (outputs.size - decided) + remembered, Nil, memories - remembered)

  /** Computes [[outputs]] without the memory that is not [[remembered]], from the inputs of [[In]], the first
    * of which are passed as the opponent's readings and this vehicle's.
    */
  lazy val function: LaneFunction =
    LaneCompiler.compile(inputs, deciding(withEffort = true), LaneObservation.READ, parameters)

  /** Computes the memory that is not [[remembered]]. */
  lazy val observing: LaneFunction = LaneCompiler.compile(
    inputs,
    outputs.slice(decided + remembered, decided + memories),
    LaneObservation.READ,
    parameters
  )

  // All outputs except the change of the heading.
  private def course = outputs.patch(2, Nil, 1)

  private[lanes] def nodes(withEffort: Boolean): Vector[Node] = if withEffort then outputs else course

  /** [[function]] without the change of the decided heading. */
  lazy val functionWithoutEffort: LaneFunction =
    LaneCompiler.compile(inputs, deciding(withEffort = false), LaneObservation.READ, parameters)

  /** [[function]] for worlds that all have one policy. */
  lazy val functionOfOne: LaneFunction = LaneCompiler.compile(inputs, course, LaneObservation.READ)

  def courseOutputs: Int = course.size

  private val plain      = derived.forall(_.op == Op.Param)
  private val indices    = derived.iterator.map(_.index).toArray
  private val evaluation = Evaluation(derived)

  def parametersOf(policy: Policy): Array[Double] =
    val own = formula.parametersOf(policy)
    if plain then indices.map(own(_))
    else evaluation(Array.emptyDoubleArray, own)

  /** The components of a policy's initial memory. */
  def initialOf(policy: Policy): Array[Double] = formula.startOf(policy)

  def fits(policy: Policy): Boolean = formula.fits(policy)

  private def turnOf(heading: Node): Option[Node] =
    if heading == own then Some(source.const(0))
    else
      heading.op match
        case Op.Add if heading.args(0) == own => Some(heading.args(1))
        case Op.Add if heading.args(1) == own => Some(heading.args(0))
        case Op.Sub if heading.args(0) == own => Some(source.neg(heading.args(1)))
        case Op.Where                         =>
          for
            a <- turnOf(heading.args(1))
            b <- turnOf(heading.args(2))
          yield source.where(heading.args(0), a, b)
        case _ => None

  private def wrapped(angle: Node): Node =
    if angle.isConst then angle else trace.binary(Op.Remainder, angle, trace.const(2 * math.Pi))

  /** The angle between this vehicle's last direction and the decided one, 2 arcsin(chord / 2), where the
    * chord is the distance between the two on the unit circle.
    */
  private def apart(cos: Node, sin: Node): Node =
    val (x, y) = (trace.sub(cos, trace.input(In.OwnCos)), trace.sub(sin, trace.input(In.OwnSin)))
    val square = trace.mul(trace.add(trace.mul(x, x), trace.mul(y, y)), trace.const(0.25))
    val half   = trace.binary(Op.Min, trace.unary(Op.Sqrt, square), trace.const(1))
    trace.sub(trace.const(math.Pi), trace.mul(trace.const(2), trace.unary(Op.Acos, half)))

private[skein] object PolicyLanes:
  /** Inputs of the compiled function; the first four are those of the policy. */
  object In:
    final val Elapsed  = 4
    final val OwnCos   = 5
    final val OwnSin   = 6
    final val KnownCos = 7
    final val KnownSin = 8

    final val Heading     = 9
    final val OwnAge      = 10
    final val OpponentAge = 11

    final val Memory = 12

  /** A policy's formula, and the SIMD code of those that it [[PolicyFormula.fits]], or why there is none. */
  private final case class Form(formula: PolicyFormula, lanes: Either[Untraceable, PolicyLanes])

  private val known = Recent[(AnyRef, Int, Boolean), Forms[Policy, Form]](most = 256)

  /** After this number of refused policies of one class, every policy of that class counts as refused. */
  private val MostRefused = 16

  /** The SIMD code of a policy, or why there is none. Compiled once for each form.
    *
    * @param self its vehicle's index, 0 or 1
    * @param isPredicted whether readings are predicted
    */
  def of(policy: Policy, self: Int, isPredicted: Boolean): Either[Untraceable, PolicyLanes] =
    val kind = policy match
      case graph: GraphPolicy => graph.graph
      case _                  => policy.getClass
    val forms = known.getOrMake((kind, self, isPredicted)):
      Forms[Policy, Form](_.formula.fits(_, OpponentFormula.Rivals), MostRefused): one =>
        for formula <- PolicyFormula.of(one, self, OpponentFormula.Rivals, isPredicted)
        yield Form(formula, OpponentFormula.of(formula, self).map(PolicyLanes(_)))
    forms(policy).flatMap(_.lanes)

  def of(policy: Policy): Either[Untraceable, PolicyLanes] = of(policy, 0, isPredicted = false)

  /** The SIMD code of a policy that is known to have it. */
  def get(policy: Policy): PolicyLanes = of(policy).fold(throw _, identity)
