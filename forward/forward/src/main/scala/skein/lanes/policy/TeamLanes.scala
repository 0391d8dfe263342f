package skein.lanes.policy

import scala.collection.mutable
import skein.formula.{Angles, Evaluation, Node, Op, Trace, Untraceable}
import skein.forward.RolloutAgent
import skein.fusion.SensorModel
import skein.policy.{Action, Assignment, Policy, PolicyFormula, PolicyInput}
import skein.policy.PolicyFormula.Motion
import skein.simd.{BoundFunction, Forms, LaneFunction, Recent, Sources}
import skein.units.{Expect, Metres}

/** SIMD decisions of a team's policies in many worlds, compiled from their own methods ([[PolicyFormula]]).
  * Teams of one form differ only in parameter values.
  *
  * What several vehicles compute from one view is computed once for all of them: for example the bearings
  * that each pursuer needs.
  */
private[lanes] final class TeamLanes private (
    formulas: Vector[PolicyFormula],
    assignment: Assignment,
    val inSpace: Boolean
) extends TeamPolicies:
  import TeamLanes.*

  val count: Int = formulas.size

  private val view  = LaneObservation.count(true, inSpace) * count
  private val trace = Trace(MostOperations)

  /** What further inputs stand for, with the vehicle that has them; -1 for values shared by all. */
  private val further = Sources[(Int, Source)](first = view)

  private def own(self: Int, source: Source): Node = trace.input(further.inputOf((self, source)))

  /** By vehicle, the headings that it needs: its own previous one, or the known one of another vehicle. */
  private val headings = Vector.tabulate(count): self =>
    val formula = formulas(self)
    val nodes   = formula.memory ++ (formula.motion match
      case Motion.Along(heading, speed) => Vector(heading, speed)
      case Motion.With(north, east)     => Vector(north, east))
    Trace
      .needed(nodes)
      .collect { case node if node.op == Op.Input => formula.inputs(node.index) }
      .collect { case PolicyInput.Heading(vehicle) => vehicle }
      .toSet

  private val angles: Vector[Angles] = Vector.tabulate(count): self =>
    val input                                 = formulas(self).inputs
    def own(source: Source)                   = this.own(self, source)
    def direction(vehicle: Int): (Node, Node) =
      if vehicle == self then (own(Source.Cos), own(Source.Sin))
      else (own(Source.KnownCos(vehicle)), own(Source.KnownSin(vehicle)))
    Angles(
      formulas(self).formula.trace,
      trace,
      input(_) match
        case PolicyInput.Position(vehicle, 2) =>
          if inSpace then trace.input(LaneObservation.DOWN * count + vehicle)
          else own(Source.Altitude(vehicle))
        case PolicyInput.Position(vehicle, axis) => trace.input(axis * count + vehicle)
        case PolicyInput.Velocity(vehicle, 2)    =>
          if inSpace then trace.input(LaneObservation.DOWN_MPS * count + vehicle) else trace.const(0)
        case PolicyInput.Velocity(vehicle, axis) => trace.input((2 + axis) * count + vehicle)
        case PolicyInput.Heading(vehicle)        =>
          val (cos, sin) = direction(vehicle)
          trace.binary(Op.Atan2, sin, cos)
        case PolicyInput.Age(vehicle)   => own(Source.Age(vehicle))
        case PolicyInput.Elapsed        => own(Source.Elapsed)
        case PolicyInput.ActsIn         => own(Source.ActsIn)
        case PolicyInput.Time           => own(Source.Time)
        case PolicyInput.Cruise         => own(Source.Cruise)
        case PolicyInput.StartDown      => own(Source.StartDown)
        case PolicyInput.Memory(number) => own(Source.Memory(number))
      ,
      input(_) match
        case PolicyInput.Heading(vehicle) => Some(direction(vehicle))
        case _                            => None
      ,
      number => own(Source.Parameter(number))
    )

  /** For each vehicle: the commanded velocity, north and east; cosine and sine of its heading, or anything
    * where it is not needed; in space the vertical part ([[PolicyFormula.Vertical]]); and the next memory.
    */
  val outputs: Vector[Vector[Node]] = Vector.tabulate(count): self =>
    val by     = angles(self)
    val course = formulas(self).motion match
      case Motion.Along(headingRad, speedMps) =>
        val (cos, sin) = by.cosSin(by.factored(headingRad))
        val speed      = by.convert(by.factored(speedMps))
        Vector(trace.mul(speed, cos), trace.mul(speed, sin), cos, sin)
      case Motion.With(northMps, eastMps) =>
        val (north, east) = (by.convert(by.factored(northMps)), by.convert(by.factored(eastMps)))
        val (cos, sin)    = if headings.exists(_(self)) then directionOf(self, north, east) else (north, east)
        Vector(north, east, cos, sin)
    val vertical = Vector.from(Option.when(inSpace):
      formulas(self).vertical.fold(Vector(own(self, Source.StartDown), trace.const(1))): each =>
        Vector(by.convert(each.third), by.convert(each.holds))).flatten
    course ++ vertical ++ formulas(self).memory.map(by.convert)

  val decided: Int = if inSpace then 6 else 4

  /** Direction of a velocity; for a velocity near zero, the previous direction. */
  private def directionOf(self: Int, north: Node, east: Node): (Node, Node) =
    val speed  = trace.binary(Op.Hypot, north, east)
    val isSlow = trace.lt(speed, trace.const(Action.LeastMps))
    val by     = trace.where(isSlow, trace.const(1), speed)
    (
      trace.where(isSlow, own(self, Source.Cos), trace.div(north, by)),
      trace.where(isSlow, own(self, Source.Sin), trace.div(east, by))
    )

  private val derived = angles.map(_.derived)
  private val numbers = derived.map(Evaluation(_))

  /** By vehicle: number of components of the memory up to the last one on which its decisions depend. The
    * others are only observed from outside.
    */
  val remembered: Vector[Int] = Vector.tabulate(count): self =>
    Trace.needed(outputs(self)).iterator.filter(node => node.op == Op.Input && node.index >= view)
      .map(node => source(node.index)).collect { case Source.Memory(number) => number + 1 }
      .maxOption.getOrElse(0)

  private def deciding(self: Int)  = outputs(self).take(decided + remembered(self))
  private def observing(self: Int) = outputs(self).drop(decided + remembered(self))

  private val common =
    Common.of(Vector.tabulate(count)(deciding) ++ Vector.tabulate(count)(observing), view)

  /** The function for what is computed once per view; may be empty. */
  val shared: BoundFunction = BoundFunction.of(common.nodes)

  /** A vehicle's parameters are rows of one array. */
  private val rowOf: PartialFunction[Int, Int] = Function.unlift: input =>
    if input < view then None else Some(source(input)).collect { case Source.Parameter(row) => row }

  private def own(outputs: Vector[Node]): BoundFunction =
    BoundFunction.of(common.without(trace, outputs, number => own(-1, Source.Shared(number))), rowOf)

  /** By vehicle: the function for its own part of the decision, without the memory that is not
    * [[remembered]].
    */
  val functions: Vector[BoundFunction] = Vector.tabulate(count)(self => own(deciding(self)))

  /** By vehicle: the function for its own part of the memory that is not [[remembered]]; may be empty. */
  val sights: Vector[BoundFunction] = Vector.tabulate(count)(self => own(observing(self)))

  /** The vehicle, and the component of its reading, for which an input stands. Components 0 to 3: position
    * north and east, velocity north and east; in space, 4 and 5: position and velocity down.
    */
  def reading(input: Int): Option[(Int, Int)] =
    Option.when(input < view)((input % count, input / count))

  def source(input: Int): Source = further(input)._2

  private val sources = functions.zip(sights).map: (decides, observes) =>
    (decides.inputs ++ observes.inputs).toVector.filter(reading(_).isEmpty).map(source)

  val needsVelocity: Boolean =
    (shared +: (functions ++ sights)).exists(_.inputs.exists(reading(_).exists((_, field) =>
      field == 2 || field == 3
    )))

  /** For each vehicle: whether it needs ages of readings, commands of other vehicles, or the time at which
    * its command takes effect, or until then.
    */
  val asksMore: Vector[Boolean] = sources.map(_.exists:
    case _: (Source.Age | Source.KnownCos | Source.KnownSin) | Source.ActsIn | Source.Time => true
    case _                                                                                 => false)

  /** By vehicle: whether it needs ages of readings. The time counts from the first reading. */
  val asksAges: Vector[Boolean] =
    sources.map(_.exists(source => source.isInstanceOf[Source.Age] || source == Source.Time))

  val asksTime: Boolean = sources.exists(_.contains(Source.Time))

  /** Whether some vehicle needs altitudes of vehicles. */
  val looksUp: Boolean = sources.exists(_.exists(_.isInstanceOf[Source.Altitude]))

  /** Whether some policy may command its vehicle's yaw. */
  val turns: Boolean = formulas.exists(_.turns)

  /** Whether all decisions use only positions, velocities, time and the vehicle's own heading. */
  private val isPlain: Boolean = !inSpace && formulas.forall(_.memory.isEmpty) && sources.flatten.forall:
    case Source.Cos | Source.Sin | Source.Elapsed | _: (Source.Parameter | Source.Shared) => true
    case _                                                                                => false

  /** Number of components of the memory of a vehicle's policy. */
  def memories(self: Int): Int = formulas(self).memory.size

  /** Number of parameters by which a vehicle's policy differs from others of its form. */
  def parameters(self: Int): Int = derived(self).size

  def numbersOf(self: Int, policy: Policy): PolicyNumbers = PolicyNumbers(
    numbers(self)(Array.emptyDoubleArray, formulas(self).parametersOf(policy)),
    formulas(self).startOf(policy)
  )

  def needsMore: Boolean          = asksMore.contains(true)
  def eyes: Map[Int, SensorModel] = Map.empty
  def sideBySide: Int             = LaneFunction.COUNT

  def refusedByGpu: Option[String] =
    Option.unless(isPlain)("the GPU flies teams without memory that look at the newest readings alone")

  /** Why an agent does not keep the altitude of its start. */
  def leaves(self: Int, agent: RolloutAgent): Option[String] =
    formulas(self).leaves(agent.policy, Metres(agent.altitudeDownM))

  private def fits(team: Team): Boolean =
    team.policies.size == count &&
      team.policies.indices.forall(self => formulas(self).fits(team.policies(self), assignment))

private[lanes] object TeamLanes:
  private val MostMemories = 1024

  private val MostOperations = 2_000_000

  /** What each vehicle has separately, some of it for each of the other vehicles; and shared values. */
  enum Source:
    case Cos, Sin, Elapsed, ActsIn, Time, Cruise, StartDown
    case Age(vehicle: Int)
    case KnownCos(vehicle: Int)
    case KnownSin(vehicle: Int)
    case Altitude(vehicle: Int)
    case Memory(number: Int)
    case Parameter(number: Int)
    case Shared(number: Int)

  private final case class Team(policies: Vector[Policy], assignment: Assignment)

  private val known = Recent[(Assignment, Boolean, Boolean), Forms[Team, TeamLanes]](most = 64)

  /** The SIMD code of a team, or why there is none. Compiled once for each form.
    *
    * @param isPredicted whether readings are predicted
    * @param inSpace whether vehicles climb
    */
  def of(
      policies: Vector[Policy],
      assignment: Assignment,
      isPredicted: Boolean,
      inSpace: Boolean = false
  ): Either[Untraceable, TeamLanes] =
    val forms = known.getOrMake((assignment, isPredicted, inSpace)):
      Forms[Team, TeamLanes](_.fits(_)): team =>
        Expect
          .each(team.policies.zipWithIndex): (policy, self) =>
            PolicyFormula.of(policy, self, assignment, isPredicted)
          .flatMap: formulas =>
            val most = formulas.map(_.memory.size).max
            Expect
              .that(most <= MostMemories)(
                Untraceable(s"it remembers $most numbers, more than $MostMemories")
              )
              .map(_ => TeamLanes(formulas, assignment, inSpace))
    forms(Team(policies, assignment))

/** Subexpressions shared by several expressions, which depend only on the first inputs.
  *
  * @param nodes the subexpressions that are worth computing once
  */
private final class Common private (val nodes: Vector[Node]):
  private val numbers = nodes.zipWithIndex.toMap

  /** The expressions with the shared subexpressions replaced by inputs. */
  def without(trace: Trace, outputs: Vector[Node], input: Int => Node): Vector[Node] =
    Trace.replaced(outputs, trace)(numbers.get(_).map(input))

private object Common:
  /** Subexpressions with fewer operations are cheaper to recompute than to load. */
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
    // A condition itself is not stored, but the values that it compares are.
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
