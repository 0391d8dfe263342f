package skein.lanes.policy

import java.util.concurrent.ConcurrentHashMap
import skein.formula.{Angles, Evaluation, Formula, Node, Op, Trace, Untraceable}
import skein.policy.{ObservingPolicy, PlanarObservation, HeadingPolicy}
import skein.simd.{Forms, LaneCompiler, LaneFunction}

/** What policies of one form have in common: how they decide in many worlds at once, compiled from the method
  * [[HeadingPolicy.heading]], or [[ObservingPolicy.decide]], itself. Policies of one form differ in numbers
  * alone.
  */
private[skein] final class PolicyLanes private (formula: Formula):
  import PolicyLanes.*

  private val trace  = Trace()
  private val source = formula.trace
  private val own    = source.input(OwnHeading)

  /** By how much it turns from its heading, where it says so; else it answers with a direction. */
  private lazy val turn: Option[Node] = turnOf(heading)

  private lazy val angles: Angles = Angles(
    source,
    trace,
    {
      case index if index <= Dvy        => trace.input(index)
      case OwnHeading if turn.isDefined => trace.input(In.Heading)
      case OwnHeading      => trace.binary(Op.Atan2, trace.input(In.OwnSin), trace.input(In.OwnCos))
      case OpponentHeading => trace.binary(Op.Atan2, trace.input(In.KnownSin), trace.input(In.KnownCos))
      case Elapsed         => trace.input(In.Elapsed)
      case OwnAge          => trace.input(In.OwnAge)
      case OpponentAge     => trace.input(In.OpponentAge)
      case remembered      => trace.input(In.Memory + remembered - Memory)
    },
    {
      case OwnHeading      => Some((trace.input(In.OwnCos), trace.input(In.OwnSin)))
      case OpponentHeading => Some((trace.input(In.KnownCos), trace.input(In.KnownSin)))
      case _               => None
    },
    trace.param
  )

  private lazy val heading = angles.factored(formula.outputs(0)._2)

  /** How many numbers a policy remembers. */
  val memories: Int = formula.outputs.size - 1

  /** Cosine and sine of the decided heading, how far it is from the one before, what is remembered, and the
    * heading itself if it is kept.
    */
  val outputs: Vector[Node] =
    val remembered = formula.outputs.tail.map((_, node) => angles.convert(node))
    turn match
      case Some(by) =>
        val change  = wrapped(angles.convert(by))
        val heading = wrapped(trace.add(trace.input(In.Heading), change))
        Vector(trace.unary(Op.Cos, heading), trace.unary(Op.Sin, heading), trace.unary(Op.Abs, change)) ++
          remembered :+ heading
      case None =>
        val (cos, sin) = angles.cosSin(heading)
        Vector(cos, sin, apart(cos, sin)) ++ remembered

  /** Whether it turns from the heading commanded last, and so decides a heading besides its direction. */
  val keepsHeading: Boolean = turn.isDefined

  /** How many of [[outputs]] come before what is remembered. */
  val decided: Int = outputs.size - memories - (if keepsHeading then 1 else 0)

  private val needed = Trace.needed(outputs)

  /** Whether it looks at velocities. */
  val needsVelocity: Boolean = looksAt(Dvx) || looksAt(Dvy)

  /** Whether it asks how old readings are. */
  val needsAges: Boolean = looksAt(In.OwnAge) || looksAt(In.OpponentAge)

  private def looksAt(input: Int) = needed.exists(node => node.op == Op.Input && node.index == input)

  private val derived = angles.derived

  /** How many numbers it differs by from another of its form. */
  def parameters: Int = derived.size

  /** How many numbers and conditions are computed at a decision. */
  def operations: Int = needed.count(_.args.nonEmpty)

  /** How many arrays it reads. */
  def inputs: Int = In.Memory + memories

  /** Computes [[outputs]] of what [[In]] lists, of which the first are told as the opponent's readings and
    * the own ones.
    */
  lazy val function: LaneFunction = LaneCompiler.compile(inputs, outputs, LaneObservation.READ, parameters)

  // But how far the decided heading is from the one before.
  private def course = outputs.patch(2, Nil, 1)

  /** What is computed at a decision. */
  private[lanes] def nodes(withEffort: Boolean): Vector[Node] = if withEffort then outputs else course

  /** The same but how far the decided heading is from the one before. */
  lazy val functionWithoutEffort: LaneFunction =
    LaneCompiler.compile(inputs, course, LaneObservation.READ, parameters)

  /** The same for worlds that all have one policy. */
  lazy val functionOfOne: LaneFunction = LaneCompiler.compile(inputs, course, LaneObservation.READ)

  /** How many numbers these compute. */
  def courseOutputs: Int = course.size

  private val plain      = derived.forall(_.op == Op.Param)
  private val indices    = derived.iterator.map(_.index).toArray
  private val evaluation = Evaluation(derived)

  def parametersOf(policy: HeadingPolicy): Array[Double] =
    val own = formula.parametersOf(policy)
    if plain then indices.map(own(_))
    else evaluation(Array.emptyDoubleArray, own)

  /** The function's inputs for what one policy sees and remembers. */
  def inputsOf(seen: PlanarObservation, memory: Any): Array[Double] =
    val (own, known) = (seen.ownHeadingRad, seen.opponentHeadingRad)
    Array(
      seen.dxM,
      seen.dyM,
      seen.dvxMps,
      seen.dvyMps,
      seen.elapsedS,
      StrictMath.cos(own),
      StrictMath.sin(own),
      StrictMath.cos(known),
      StrictMath.sin(known),
      StrictMath.IEEEremainder(own, 2 * math.Pi),
      seen.ownAgeS,
      seen.opponentAgeS
    ) ++ numbersOf(memory)

  /** What a policy remembers before its first decision. */
  def initialOf(policy: HeadingPolicy): Array[Double] = numbersOf(ObservingPolicy.initialOf(policy)).toArray

  /** Whether a policy is of this form. */
  def fits(policy: HeadingPolicy): Boolean = formula.fits(policy)

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

  /** The angle between the own direction and the decided one: two directions a chord apart are 2 arcsin(chord
    * / 2).
    */
  private def apart(cos: Node, sin: Node): Node =
    val (x, y) = (trace.sub(cos, trace.input(In.OwnCos)), trace.sub(sin, trace.input(In.OwnSin)))
    val square = trace.mul(trace.add(trace.mul(x, x), trace.mul(y, y)), trace.const(0.25))
    val half   = trace.binary(Op.Min, trace.unary(Op.Sqrt, square), trace.const(1))
    trace.sub(trace.const(math.Pi), trace.mul(trace.const(2), trace.unary(Op.Acos, half)))

private[skein] object PolicyLanes:
  // The arguments of HeadingPolicy.heading, by place.
  private final val Dvx             = 2
  private final val Dvy             = 3
  private final val OwnHeading      = 4
  private final val OpponentHeading = 5
  private final val Elapsed         = 6
  // Those of ObservingPolicy.decide go on.
  private final val OwnAge      = 7
  private final val OpponentAge = 8
  private final val Memory      = 9

  /** Inputs of the compiled function; the first four are those of the policy. */
  object In:
    final val Elapsed  = 4
    final val OwnCos   = 5
    final val OwnSin   = 6
    final val KnownCos = 7
    final val KnownSin = 8

    /** Rad, commanded last. */
    final val Heading     = 9
    final val OwnAge      = 10
    final val OpponentAge = 11

    /** The first of the numbers remembered. */
    final val Memory = 12

  /** A memory's numbers in their order. */
  private def numbersOf(memory: Any): Vector[Double] = memory match
    case number: Double         => Vector(number)
    case several: Product       => several.productIterator.flatMap(numbersOf).toVector
    case numbers: Array[Double] => numbers.toVector
    case _                      => Vector.empty

  private val known = ConcurrentHashMap[Class[?], Forms[HeadingPolicy, PolicyLanes]]()

  /** Policies of a class that are no formulas, before all of it are taken for none. */
  private val MostRefused = 16

  /** How a policy flies by lanes, or why it does not. Compiled once for each form. */
  def of(policy: HeadingPolicy): Either[Untraceable, PolicyLanes] =
    known.computeIfAbsent(
      policy.getClass,
      _ => Forms[HeadingPolicy, PolicyLanes](_.fits(_), MostRefused)(formulaOf(_).map(PolicyLanes(_)))
    )(policy)

  private def formulaOf(policy: HeadingPolicy): Either[Untraceable, Formula] = policy match
    case observing: ObservingPolicy[?] => Formula.of(observing, "decide")
    case _ => Formula.of(policy, "heading", arguments = Some(Seq.fill(7)(classOf[Double])))

  /** Of a policy that is known to be a formula. */
  def get(policy: HeadingPolicy): PolicyLanes = of(policy).fold(throw _, identity)
