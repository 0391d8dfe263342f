package skein.lanes.policy

import skein.formula.{Node, Op, Trace, Untraceable}
import skein.policy.{Assignment, Policy, PolicyFormula, PolicyInput}
import skein.policy.PolicyFormula.Motion
import skein.units.Expect

/** The decision of one of two opponents, if it is a heading at the vehicle's own speed and at the altitude of
  * its start, and depends only on the difference of the two readings: a [[PolicyFormula]] with its inputs
  * replaced by those of [[OpponentFormula.In]].
  *
  * @param heading the commanded heading
  * @param memory the components of the memory after the decision
  */
private[policy] final class OpponentFormula private (
    formula: PolicyFormula,
    val trace: Trace,
    val heading: Node,
    val memory: Vector[Node]
):
  import OpponentFormula.Rivals

  def fits(policy: Policy): Boolean = formula.fits(policy, Rivals)

  def parametersOf(policy: Policy): Array[Double] = formula.parametersOf(policy)

  def startOf(policy: Policy): Array[Double] = formula.startOf(policy)

private[policy] object OpponentFormula:
  /** Two vehicles, each the only rival of the other. */
  val Rivals: Assignment = Assignment(Vector(Vector(1), Vector(0)))

  /** The inputs: the opponent's position minus this vehicle's, north and east, m; likewise its velocity, m/s;
    * the headings commanded last, rad; time since this vehicle's previous decision, ages of both readings, s;
    * and the components of the memory.
    */
  object In:
    final val Dx              = 0
    final val Dvx             = 2
    final val Dvy             = 3
    final val OwnHeading      = 4
    final val OpponentHeading = 5
    final val Elapsed         = 6
    final val OwnAge          = 7
    final val OpponentAge     = 8
    final val Memory          = 9

  /** @param self the vehicle's index, 0 or 1
    * @return Left says why it is of another kind
    */
  def of(formula: PolicyFormula, self: Int): Either[Untraceable, OpponentFormula] =
    import formula.motion
    val trace                              = Trace()
    def inputOf(node: Node)                = Option.when(node.op == Op.Input)(formula.inputs(node.index))
    def replaced(node: Node): Option[Node] = node.op match
      case Op.Sub   => difference(inputOf(node.args(0)), inputOf(node.args(1)), self, trace)
      case Op.Input =>
        Some(trace.input(placeOf(formula.inputs(node.index), self).getOrElse(Other + node.index)))
      case _ => None
    for
      heading <- motion match
        case Motion.Along(heading, speed) if inputOf(speed).contains(PolicyInput.Cruise) => Right(heading)
        case _ => Left(Untraceable("it decides for another speed than its vehicle's"))
      _ <- Expect.that(formula.vertical.isEmpty && !formula.turns):
        Untraceable("it leaves the altitude of its vehicle's start, or turns the vehicle")
      nodes  = Trace.replaced(heading +: formula.memory, trace)(replaced)
      others = Trace.needed(nodes).find(node => node.op == Op.Input && node.index >= Other)
      _ <- others
        .map(node =>
          Untraceable(s"it regards ${formula.inputs(node.index - Other)}, and not by a difference")
        )
        .toLeft(())
    yield OpponentFormula(formula, trace, nodes.head, nodes.tail)

  // Inputs other than these are numbered from here on while the graph is searched for differences.
  private final val Other = 1 << 20

  private def placeOf(input: PolicyInput, self: Int): Option[Int] = input match
    case PolicyInput.Heading(vehicle) => Some(if vehicle == self then In.OwnHeading else In.OpponentHeading)
    case PolicyInput.Age(vehicle)     => Some(if vehicle == self then In.OwnAge else In.OpponentAge)
    case PolicyInput.Elapsed          => Some(In.Elapsed)
    case PolicyInput.Memory(number)   => Some(In.Memory + number)
    case _                            => None

  /** The difference of two inputs, if it is one of two level readings. */
  private def difference(from: Option[PolicyInput], less: Option[PolicyInput], self: Int, trace: Trace) =
    import PolicyInput.{Position, Velocity}
    def signed(vehicle: Int, input: Int) =
      if vehicle == self then trace.neg(trace.input(input)) else trace.input(input)
    (from, less) match
      case (Some(Position(one, a)), Some(Position(other, b))) if one != other && a == b && a < 2 =>
        Some(signed(one, In.Dx + a))
      case (Some(Velocity(one, a)), Some(Velocity(other, b))) if one != other && a == b && a < 2 =>
        Some(signed(one, In.Dvx + a))
      case _ => None
