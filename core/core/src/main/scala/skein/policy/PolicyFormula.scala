package skein.policy

import scala.util.control.NonFatal
import skein.formula.{Answer, Evaluation, Example, Formula, Node, Op, Trace, Untraceable}
import skein.signal.Kinematics
import skein.units.*

/** How a policy decides at one place of a team, as a formula of numbers: [[Policy.choose]], or
  * [[PlanarPolicy.planar]], read from its bytecode. It is for forward simulation, whose vehicles fly
  * horizontal velocities at the altitude of their start: what is decided for must be one.
  *
  * @param inputs what each of the formula's inputs is
  * @param motion what is decided
  * @param down of the velocity that is decided for; absent where it is that of the start in any case
  * @param memory what is remembered, in the order of [[PolicyInput.Memory]]
  * @param turns whether it may ask its vehicle to turn
  */
final class PolicyFormula private (
    val formula: Formula,
    val inputs: Vector[PolicyInput],
    val motion: PolicyFormula.Motion,
    down: Option[Node],
    val memory: Vector[Node],
    val turns: Boolean,
    start: Example,
    assignment: Assignment
):
  import PolicyFormula.*

  /** Whether another policy differs in numbers alone. */
  def fits(policy: Policy, assignment: Assignment): Boolean =
    formula.fits(Deciding.of(policy, assignment)) && start.isLike(memoryOf(policy))

  /** The numbers of a policy that [[fits]], for the formula's parameters. */
  def parametersOf(policy: Policy): Array[Double] =
    formula.parametersOf(Deciding.of(policy, assignment))

  /** What a policy that [[fits]] remembers before its first decision. */
  def startOf(policy: Policy): Array[Double] = memoryOf(policy).numbers.toArray

  /** Why it does not fly at the altitude of its vehicle's start alone, if it does not.
    *
    * @param startDown of a vehicle that it decides for
    */
  def leaves(policy: Policy, startDown: Metres): Option[String] = down.flatMap: node =>
    val isFixed = Trace.needed(Seq(node)).forall(_.op != Op.Input)
    val told    = "it flies at another altitude than that of its vehicle's start"
    Option.unless(
      isFixed && Evaluation(Vector(node))(Array.emptyDoubleArray, parametersOf(policy))(0) == startDown.value
    )(told)

/** What an input of a [[PolicyFormula]] is. */
enum PolicyInput:
  /** Of a vehicle's estimate, m.
    *
    * @param axis 0 north, 1 east, 2 down
    */
  case Position(vehicle: Int, axis: Int)

  /** The same, m/s. */
  case Velocity(vehicle: Int, axis: Int)

  /** Commanded last, rad. */
  case Heading(vehicle: Int)

  /** Of the reading behind a vehicle's estimate, s. */
  case Age(vehicle: Int)

  /** Since the own last decision, s. */
  case Elapsed

  /** Until the command acts, s. */
  case ActsIn

  /** The vehicle's own speed, m/s. */
  case Cruise

  /** Of the vehicle's start, m. */
  case StartDown

  /** What is remembered, by number. */
  case Memory(number: Int)

object PolicyFormula:

  /** What a formula decides for. */
  enum Motion:
    /** A heading, rad, and a speed, m/s. */
    case Along(heading: Node, speed: Node)

    /** A velocity, m/s. */
    case With(north: Node, east: Node)

  /** @param self the policy's place in its team
    * @param isPredicted see [[Seen.isPredicted]]
    * @return or why it is none, with the line
    */
  def of(
      policy: Policy,
      self: Int,
      assignment: Assignment,
      isPredicted: Boolean
  ): Either[Untraceable, PolicyFormula] =
    val count = assignment.rivals.size
    val seen  = Tagged(self, count, assignment.rivals(self), isPredicted)
    for
      _    <- Either.cond(policy.sensors.isEmpty, (), Untraceable("it reads sensors, which no model has"))
      kept <- startOf(policy)
      (memory, starts) = kept
      target           = Deciding.of(policy, assignment)
      read             = Reading(seen, memory)
      loader           = Option(policy.getClass.getClassLoader).getOrElse(ClassLoader.getSystemClassLoader)
      traced <-
        Formula.ofExamples(target, "decide", Deciding.Descriptor, Seq(seen.example, memory), loader)(read.of)
    yield
      val (formula, decided) = traced
      val inputs             = seen.inputs ++ starts.indices.map(PolicyInput.Memory(_))
      new PolicyFormula(
        formula,
        inputs,
        decided.motion,
        decided.down,
        decided.memory,
        decided.turns,
        memory,
        assignment
      )

  /** What a policy remembers before its first decision, and its numbers. */
  private def startOf(policy: Policy): Either[Untraceable, (Example, Vector[Double])] =
    try
      val memory = memoryOf(policy)
      Right((memory, memory.numbers))
    catch
      case refused: Untraceable => Left(refused)
      case NonFatal(mistake)    => Left(Untraceable(s"its start fails: $mistake"))

  private def memoryOf(policy: Policy) =
    Example("memory", policy.start.asInstanceOf[AnyRef], takesWholes = true)

  private final case class Decided(motion: Motion, down: Option[Node], memory: Vector[Node], turns: Boolean)

  /** Reads what a policy answers. */
  private final class Reading(seen: Tagged, memory: Example):
    def of(trace: Trace, answer: Answer): (Vector[(String, Node)], Decided) =
      val next                  = answer.get("_2").numbersOf(memory)
      val (motion, down, turns) = answer.get("_1").fold(one)(chosen(trace))
      val ofMotion              = motion match
        case Motion.Along(heading, speed) => Vector("heading" -> heading, "speed" -> speed)
        case Motion.With(north, east)     => Vector("north" -> north, "east" -> east)
      val start   = trace.input(seen.inputs.indexOf(PolicyInput.StartDown))
      val leaving = down.filter(_ != start)
      val outputs =
        ofMotion ++ leaving.map("down" -> _) ++ next.zipWithIndex.map((node, i) => s"memory$i" -> node)
      (outputs, Decided(motion, leaving, next, turns))

    private type Part = (Motion, Option[Node], Boolean)

    private def one(of: String, answer: Answer): Part =
      if of == classOf[Course].getName then
        val motion = Motion.Along(answer.get("headingRad", "D").number, answer.get("speedMps", "D").number)
        (motion, None, false)
      else if of == classOf[Action.VelocityAt].getName then
        val motion  = Motion.With(answer.get("northMps", "D").number, answer.get("eastMps", "D").number)
        val isStill = answer
          .get("yaw", s"L${classOf[Yaw].getName.replace('.', '/')};")
          .isOne(Yaw.Still)
        (motion, Some(answer.get("down", "D").number), !isStill)
      else
        val name = of.substring(of.lastIndexOf('.') + 1).replace('$', '.')
        answer.refuse(
          s"it decides for $name; forward simulation flies Action.VelocityAt at the start's altitude"
        )

    private def chosen(trace: Trace)(condition: Node, a: Part, b: Part): Part =
      def either(x: Node, y: Node) = trace.where(condition, x, y)
      val motion                   = (a._1, b._1) match
        case (Motion.Along(x, v), Motion.Along(y, w)) => Motion.Along(either(x, y), either(v, w))
        case (Motion.With(x, v), Motion.With(y, w))   => Motion.With(either(x, y), either(v, w))
        case other                                    => throw IllegalStateException(s"came $other")
      (motion, a._2.zip(b._2).map(either), a._3 || b._3)

/** An observation in which every number tells which input it is. */
private final class Tagged(self: Int, count: Int, rivals: Vector[Int], isPredicted: Boolean):
  private val told = Vector.newBuilder[PolicyInput]
  private var next = 0

  private def tag(input: PolicyInput): Double =
    told += input
    next += 1
    (next - 1).toDouble

  private def span(input: PolicyInput) = Span.ofNanos(tag(input).toLong)

  private def vector(of: Int => PolicyInput) = Vector3(tag(of(0)), tag(of(1)), tag(of(2)))

  /** In the order in which the fields are declared, as an example's numbers are. */
  val example: Example = Example(
    "seen",
    Observation(
      self,
      Vector.tabulate(count): vehicle =>
        Seen(
          Kinematics(
            vector(PolicyInput.Position(vehicle, _)),
            vector(PolicyInput.Velocity(vehicle, _)),
            Quaternion.Identity,
            Vector3.Zero
          ),
          span(PolicyInput.Age(vehicle)),
          isPredicted
        ),
      rivals.head,
      Vector.tabulate(count)(vehicle => Radians(tag(PolicyInput.Heading(vehicle)))),
      span(PolicyInput.Elapsed),
      0,
      MetresPerSecond(tag(PolicyInput.Cruise)),
      Metres(tag(PolicyInput.StartDown)),
      Map.empty,
      span(PolicyInput.ActsIn)
    ),
    refused = Tagged.Refused
  )

  val inputs: Vector[PolicyInput] = told.result()

private object Tagged:
  private val attitude = "it reads the attitude, which models of vehicles do not tell"

  val Refused: Map[String, String] = Map(
    "Kinematics.orientation"        -> attitude,
    "Kinematics.angularVelocityFrd" -> attitude,
    "Observation.sensed"            -> "it reads sensors, which no model has",
    "Observation.decisions"         ->
      "it counts its decisions; deciding twice as often must not act twice as strongly, so integrate over elapsed"
  )

/** What is traced of a policy: it decides against the opponent that is the nearest at this moment. */
private sealed abstract class Deciding(assignment: Assignment):
  final protected def facing(seen: Observation): Observation =
    val own = seen.own.kinematics.positionNed
    seen.copy(opponent =
      assignment.opponentOf(
        seen.self,
        other => own.horizontalDistance(seen.vehicles(other).kinematics.positionNed)
      )
    )

private final class DecidingAction(policy: Policy, assignment: Assignment) extends Deciding(assignment):
  def decide(seen: Observation, memory: AnyRef): AnyRef =
    policy.choose(facing(seen), memory.asInstanceOf[policy.Memory])

private final class DecidingPlanar(policy: PlanarPolicy, assignment: Assignment) extends Deciding(assignment):
  def decide(seen: Observation, memory: AnyRef): AnyRef =
    val (chosen, next) = policy.planar(facing(seen), memory.asInstanceOf[policy.Memory])
    (Course(chosen.heading.value, chosen.speed.getOrElse(seen.cruise).value), next)

private object Deciding:
  val Descriptor = "(Lskein/policy/Observation;Ljava/lang/Object;)Ljava/lang/Object;"

  def of(policy: Policy, assignment: Assignment): Deciding = policy match
    case planar: PlanarPolicy => DecidingPlanar(planar, assignment)
    case other                => DecidingAction(other, assignment)
