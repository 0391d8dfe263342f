package skein.policy

import skein.formula.{Evaluation, Node, Op}

/** The decision of a policy as data, for one index in a team.
  *
  * @param inputs meaning of each input of the nodes; the next input is the time ahead of a goal, s
  * @param settings names of the nodes' parameters
  * @param actions actions and their conditions: the first action whose condition holds is performed; the last
  *   one has no condition
  * @param starts components of the memory before the first decision; they depend only on settings
  * @param next components of the next memory
  * @param goal the wanted position, north and east, m; empty for a policy without a goal
  * @param limits a goal's maximum speed, m/s, and minimum separation, m; they depend only on settings
  */
private[skein] final class PolicyGraph(
    val inputs: Vector[PolicyInput],
    val settings: Vector[String],
    actions: Vector[(Option[Node], GraphAction[Node])],
    val starts: Vector[Node],
    next: Vector[Node],
    val goal: Vector[Node],
    limits: Vector[Node]
):
  require(actions.nonEmpty && actions.last._1.isEmpty, "the last action has no condition")
  require(starts.size == next.size, "each number of the memory has a start and a next value")

  /** Condition and components of each action, in turn, and then the next memory. */
  val outputs: Vector[Node] = actions.flatMap((when, of) => when ++ of.numbers) ++ next

  /** Splits values of [[outputs]].
    *
    * @return the actions with their conditions, and the next memory
    */
  def choices[A](values: Vector[A]): (Vector[(Option[A], GraphAction[A])], Vector[A]) =
    actions.foldLeft((Vector.empty[(Option[A], GraphAction[A])], values)):
      case ((done, left), (when, of)) =>
        val (condition, rest)  = left.splitAt(when.size)
        val (numbers, further) = rest.splitAt(of.numbers.size)
        (done :+ (condition.headOption, GraphAction(of.kind, numbers, of.yaw)), further)

  /** Whether every action is a horizontal velocity at the altitude of the start. */
  val isPlanar: Boolean = actions.forall: (_, of) =>
    (of.kind == GraphAction.Kind.Along || of.kind == GraphAction.Kind.VelocityAt) &&
      of.numbers(2).op == Op.Input && inputs(of.numbers(2).index) == PolicyInput.StartDown

  private[policy] val deciding = Evaluation(outputs)
  private[policy] val wanting  = Evaluation(goal)
  private[policy] val starting = Evaluation(starts ++ limits)

/** A policy that is data, for example one traced in Python: a [[PolicyGraph]] with values of its settings. It
  * decides in double precision; forward simulation uses the graph as its formula.
  */
private[skein] sealed class GraphPolicy(val graph: PolicyGraph, val values: Array[Double]) extends Policy:
  type Memory = Array[Double]

  protected val settled: Array[Double] = graph.starting(Array.emptyDoubleArray, values)

  def start: Array[Double] = settled.take(graph.starts.size)

  override def isPlanar: Boolean = graph.isPlanar

  def choose(seen: Observation, memory: Array[Double]): (Action, Array[Double]) =
    val numbers         = graph.deciding(read(seen, memory), values)
    val (choices, next) = graph.choices(numbers.toVector)
    val chosen          = choices.find((when, _) => when.forall(_ != 0)).get._2
    (chosen.action(identity), next.toArray)

  protected def read(seen: Observation, memory: Array[Double]): Array[Double] =
    graph.inputs.iterator
      .map:
        case PolicyInput.Position(vehicle, axis) =>
          seen.vehicles(vehicle).kinematics.positionNed.component(axis)
        case PolicyInput.Velocity(vehicle, axis) =>
          seen.vehicles(vehicle).kinematics.velocityNed.component(axis)
        case PolicyInput.Heading(vehicle) => seen.headings(vehicle).value
        case PolicyInput.Age(vehicle)     => seen.vehicles(vehicle).age.toSeconds
        case PolicyInput.Elapsed          => seen.elapsed.toSeconds
        case PolicyInput.ActsIn           => seen.actsIn.toSeconds
        case PolicyInput.Time             => seen.time.toSeconds
        case PolicyInput.Cruise           => seen.cruise.value
        case PolicyInput.StartDown        => seen.startDown.value
        case PolicyInput.Memory(number)   => memory(number)
      .toArray

  override def equals(other: Any): Boolean = other match
    case same: GraphPolicy => (same.graph eq graph) && same.values.sameElements(values)
    case _                 => false

  override def hashCode: Int = values.toSeq.hashCode

  override def toString: String = values.mkString("GraphPolicy(", ", ", ")")

private[skein] object GraphPolicy:
  def apply(graph: PolicyGraph, values: Array[Double]): GraphPolicy =
    if graph.goal.isEmpty then new GraphPolicy(graph, values) else WithGoal(graph, values)

  private final class WithGoal(graph: PolicyGraph, values: Array[Double])
      extends GraphPolicy(graph, values), Goal:
    private val limits = settled.drop(graph.starts.size)

    def wanted(seen: Observation, aheadS: Double): (Double, Double) =
      val found = graph.wanting(read(seen, start) :+ aheadS, values)
      (found(0), found(1))

    def mostMps: Double           = limits(0)
    override def minimumM: Double = limits(1)
