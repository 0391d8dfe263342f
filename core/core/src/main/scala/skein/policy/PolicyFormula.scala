package skein.policy

import scala.util.control.NonFatal
import skein.formula.{Answer, Evaluation, Example, Formula, Node, Op, Trace, Untraceable}
import skein.units.*

/** The decision of a policy for one index in a team, as a formula: [[Policy.choose]], read from its bytecode.
  * Forward simulation uses it; its vehicles follow velocities, with or without an altitude, so the actions
  * must be of that kind.
  *
  * @param inputs meaning of each of the formula's inputs
  */
final class PolicyFormula private (
    val formula: Formula,
    val inputs: Vector[PolicyInput],
    decided: PolicyFormula.Decided,
    start: Example,
    assignment: Assignment
):
  import PolicyFormula.*
  export decided.{memory, motion, turns, vertical}

  def fits(policy: Policy, assignment: Assignment): Boolean =
    formula.fits(Deciding(policy, assignment)) && (isBegun(policy) || start.isLike(memoryOf(policy)))

  /** The formula's parameters for `policy`, which must fit the formula (see [[fits]]). */
  def parametersOf(policy: Policy): Array[Double] =
    formula.parametersOf(Deciding(policy, assignment))

  /** The initial memory of `policy`, which must fit the formula (see [[fits]]). */
  def startOf(policy: Policy): Array[Double] =
    (if isBegun(policy) then start else memoryOf(policy)).numbers.toArray

  /** Whether its initial memory is that of the formula's own policy; a shortcut for the many candidates of a
    * search.
    */
  private def isBegun(policy: Policy) = start.value.equals(policy.start)

  /** Why the policy leaves the altitude of its vehicle's start, if it does.
    *
    * @param startDown the start's altitude, of the vehicle that it controls
    */
  def leaves(policy: Policy, startDown: Metres): Option[String] = vertical.flatMap: vertical =>
    val nodes   = Vector(vertical.third, vertical.holds)
    val isFixed = Trace.needed(nodes).forall(_.op != Op.Input)
    Option.unless(
      isFixed && Evaluation(nodes)(Array.emptyDoubleArray, parametersOf(policy)).toSeq ==
        Seq(startDown.value, 1)
    )("it leaves the altitude of its vehicle's start")

object PolicyFormula:

  /** The motion that a formula decides: by heading and speed, or by velocity. */
  enum Motion:
    case Along(heading: Node, speed: Node)

    case With(north: Node, east: Node)

  /** The vertical part of a decision.
    *
    * @param third the altitude to hold, m down, where `holds` is 1; the velocity down, m/s, where it is 0
    */
  final case class Vertical(third: Node, holds: Node)

  /** Traces a policy's decision.
    *
    * @param self the vehicle's index in its team
    * @param isPredicted see [[Seen.isPredicted]]
    * @return Left says why it cannot be traced, with the source line
    */
  def of(
      policy: Policy,
      self: Int,
      assignment: Assignment,
      isPredicted: Boolean
  ): Either[Untraceable, PolicyFormula] =
    val count = assignment.rivals.size
    val seen  = Tagged(self, count, assignment.rivals(self), isPredicted)
    policy match
      case known: GraphPolicy => ofGraph(known, seen, assignment)
      case _                  => lifted(policy, seen, assignment)

  private def ofGraph(
      policy: GraphPolicy,
      seen: Tagged,
      assignment: Assignment
  ): Either[Untraceable, PolicyFormula] =
    val graph  = policy.graph
    val trace  = Trace()
    val inputs = seen.inputs ++ graph.starts.indices.map(PolicyInput.Memory(_))
    val moved  = Trace.replaced(graph.outputs, trace): node =>
      Option.when(node.op == Op.Input)(trace.input(inputs.indexOf(graph.inputs(node.index))))
    val reading         = Reading(seen)
    val (choices, rest) = graph.choices(moved)

    def part(of: GraphAction[Node]): Either[Untraceable, reading.Part] =
      import of.numbers
      def held                   = Vertical(numbers(2), trace.const(1))
      def sinking(downMps: Node) = Vertical(downMps, trace.const(0))
      def still                  = trace.const(0)
      val moved                  = of.kind match
        case GraphAction.Kind.Along      => Right((Motion.Along(numbers(0), numbers(1)), held))
        case GraphAction.Kind.VelocityAt => Right((Motion.With(numbers(0), numbers(1)), held))
        case GraphAction.Kind.Velocity   => Right((Motion.With(numbers(0), numbers(1)), sinking(numbers(2))))
        case GraphAction.Kind.Hover      => Right((Motion.With(still, still), sinking(still)))
        case other                       => Left(Untraceable(unflown(s"Action.$other")))
      moved.map((motion, vertical) => (motion, vertical, of.yaw != GraphAction.YawKind.Still))
    for parts <- Expect.each(choices)((when, of) => part(of).map((when, _)))
    yield
      val part = parts.init.foldRight(parts.last._2):
        case ((when, one), otherwise) => reading.chosen(trace)(when.getOrElse(trace.always), one, otherwise)
      val (outputs, decided) = reading.decided(trace, part, rest.take(graph.starts.size))
      val formula            = Formula.ofGraph(trace, inputs.map(_.toString), outputs, graph.settings)(
        Deciding.graphOf(_).exists(_.graph eq graph)
      )(Deciding.graphOf(_).fold(Array.emptyDoubleArray)(_.values))
      new PolicyFormula(formula, inputs, decided, memoryOf(policy), assignment)

  private def unflown(action: String) =
    s"it decides for $action; SIMD flies Action.Along, VelocityAt, Velocity and Hover"

  private def lifted(
      policy: Policy,
      seen: Tagged,
      assignment: Assignment
  ): Either[Untraceable, PolicyFormula] =
    for
      _    <- Either.cond(policy.sensors.isEmpty, (), Untraceable("it reads sensors, which no model has"))
      kept <- startOf(policy)
      (memory, starts) = kept
      target           = Deciding(policy, assignment)
      read             = Reading(seen)
      loader           = Option(policy.getClass.getClassLoader).getOrElse(ClassLoader.getSystemClassLoader)
      traced <-
        Formula.ofExamples(
          target,
          "decide",
          Deciding.Descriptor,
          Seq(seen.example, memory),
          loader
        )(read.of(memory))
    yield
      val (formula, decided) = traced
      val inputs             = seen.inputs ++ starts.indices.map(PolicyInput.Memory(_))
      new PolicyFormula(formula, inputs, decided, memory, assignment)

  /** A policy's initial memory, as an example and as components. */
  private def startOf(policy: Policy): Either[Untraceable, (Example, Vector[Double])] =
    try
      val memory = memoryOf(policy)
      Right((memory, memory.numbers))
    catch
      case refused: Untraceable => Left(refused)
      case NonFatal(mistake)    => Left(Untraceable(s"its start fails: $mistake"))

  private def memoryOf(policy: Policy) =
    Example("memory", policy.start.asInstanceOf[AnyRef], takesWholes = true)

  /** @param motion nodes of the decided horizontal motion
    * @param vertical nodes of the decided vertical motion; None if it is always the altitude of the start
    * @param memory nodes of the next memory, in the order of [[PolicyInput.Memory]]
    * @param turns whether its actions may turn the vehicle
    */
  private final case class Decided(
      motion: Motion,
      vertical: Option[Vertical],
      memory: Vector[Node],
      turns: Boolean
  )

  private final class Reading(seen: Tagged):
    def of(memory: Example)(trace: Trace, answer: Answer): (Vector[(String, Node)], Decided) =
      val next = answer.get("_2").numbersOf(memory)
      decided(trace, answer.get("_1").fold(one(trace))(chosen(trace)), next)

    def decided(trace: Trace, part: Part, next: Vector[Node]): (Vector[(String, Node)], Decided) =
      val (motion, vertical, turns) = part
      val ofMotion                  = motion match
        case Motion.Along(heading, speed) => Vector("heading" -> heading, "speed" -> speed)
        case Motion.With(north, east)     => Vector("north" -> north, "east" -> east)
      val start   = trace.input(seen.inputs.indexOf(PolicyInput.StartDown))
      val leaving =
        Option.unless(vertical.third == start && vertical.holds == trace.const(1))(vertical)
      val outputs =
        ofMotion ++ leaving.toVector.flatMap(each =>
          Vector("third" -> each.third, "holds" -> each.holds)
        ) ++ next.zipWithIndex.map((node, i) => s"memory$i" -> node)
      (outputs, Decided(motion, leaving, next, turns))

    type Part = (Motion, Vertical, Boolean)

    private def one(trace: Trace)(of: String, answer: Answer): Part =
      val still = trace.const(0)
      if answer.isOne(Action.Hover) then (Motion.With(still, still), Vertical(still, still), false)
      else moving(trace)(of, answer)

    private def moving(trace: Trace)(of: String, answer: Answer): Part =
      def number(field: String) = answer.get(field, "D").number
      def held                  = Vertical(number("down"), trace.const(1))
      val (motion, vertical)    =
        if of == classOf[Action.Along].getName then (Motion.Along(number("heading"), number("speed")), held)
        else if of == classOf[Action.VelocityAt].getName then
          (Motion.With(number("northMps"), number("eastMps")), held)
        else if of == classOf[Action.Velocity].getName then
          val velocity = answer.get("velocityNed", s"L${classOf[Vector3].getName.replace('.', '/')};")
          def along(field: String) = velocity.get(field, "D").number
          (Motion.With(along("x"), along("y")), Vertical(along("z"), trace.const(0)))
        else
          val name = of.substring(of.lastIndexOf('.') + 1).replace('$', '.')
          answer.refuse(unflown(name))
      val yaw = answer.get("yaw", s"L${classOf[Yaw].getName.replace('.', '/')};")
      (motion, vertical, !yaw.isOne(Yaw.Still))

    def chosen(trace: Trace)(condition: Node, a: Part, b: Part): Part =
      def either(x: Node, y: Node) = trace.where(condition, x, y)
      val motion                   = (a._1, b._1) match
        case (Motion.With(x, v), Motion.With(y, w)) => Motion.With(either(x, y), either(v, w))
        case (one, other)                           =>
          val ((x, v), (y, w)) = (along(trace, one), along(trace, other))
          Motion.Along(either(x, y), either(v, w))
      val vertical = Vertical(either(a._2.third, b._2.third), either(a._2.holds, b._2.holds))
      (motion, vertical, a._3 || b._3)

    /** Heading and speed of an action, as [[Action.headingRad]] defines them. */
    private def along(trace: Trace, motion: Motion): (Node, Node) = motion match
      case Motion.Along(heading, speed) => (heading, speed)
      case Motion.With(north, east)     =>
        val speed  = trace.binary(Op.Hypot, north, east)
        val before = trace.input(seen.inputs.indexOf(PolicyInput.Heading(seen.self)))
        val isSlow = trace.lt(speed, trace.const(Action.LeastMps))
        (trace.where(isSlow, before, trace.binary(Op.Atan2, east, north)), speed)

/** An observation in which every number identifies its input. */
private final class Tagged(val self: Int, count: Int, rivals: Vector[Int], isPredicted: Boolean):
  private val tags = InputTags()

  /** The observation as an example for tracing; its inputs have the order of the formula's inputs. */
  val example: Example = Example(
    "seen",
    Observation(
      self,
      Vector.tabulate(count)(tags.seen(_, isPredicted)),
      rivals.head,
      Vector.tabulate(count)(vehicle => Radians(tags.tag(PolicyInput.Heading(vehicle)))),
      tags.span(PolicyInput.Elapsed),
      0,
      MetresPerSecond(tags.tag(PolicyInput.Cruise)),
      Metres(tags.tag(PolicyInput.StartDown)),
      Map.empty,
      tags.span(PolicyInput.ActsIn),
      tags.span(PolicyInput.Time)
    ),
    refused = Tagged.Refused
  )

  val inputs: Vector[PolicyInput] = tags.inputs

private object Tagged:
  val Refused: Map[String, String] = InputTags.Refused ++ Map(
    "Observation.sensed"    -> "it reads sensors, which no model has",
    "Observation.decisions" ->
      "it counts its decisions; deciding twice as often must not act twice as strongly, so integrate over elapsed"
  )

/** The traced method: decides against the opponent that is nearest at the moment. */
private final class Deciding(val policy: Policy, assignment: Assignment):
  def decide(seen: Observation, memory: AnyRef): AnyRef =
    val own    = seen.own.kinematics.positionNed
    val facing = seen.copy(opponent =
      assignment.opponentOf(
        seen.self,
        other => own.horizontalDistance(seen.vehicles(other).kinematics.positionNed)
      )
    )
    policy.choose(facing, memory.asInstanceOf[policy.Memory])

private object Deciding:
  def graphOf(target: AnyRef): Option[GraphPolicy] = target match
    case deciding: Deciding =>
      deciding.policy match
        case graph: GraphPolicy => Some(graph)
        case _                  => None
    case _ => None

  val Descriptor = "(Lskein/policy/Observation;Ljava/lang/Object;)Ljava/lang/Object;"
