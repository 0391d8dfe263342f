package skein.scenario

import skein.formula.{Evaluation, Formula, Node, Trace}
import skein.policy.PolicyInput

/** A value computed from the present knowledge of all vehicles, as data.
  *
  * @param inputs meaning of the node's inputs: positions, velocities, ages and the time since the first
  *   decision
  */
private[scenario] final class Watched(trace: Trace, node: Node, val inputs: Vector[PolicyInput]):
  private val evaluation = Evaluation(Vector(node))

  def apply(known: Known, values: Array[Double]): Double = at(values):
    case PolicyInput.Position(vehicle, axis) => known.vehicles(vehicle).kinematics.positionNed.component(axis)
    case PolicyInput.Velocity(vehicle, axis) => known.vehicles(vehicle).kinematics.velocityNed.component(axis)
    case PolicyInput.Age(vehicle)            => known.vehicles(vehicle).age.toSeconds
    case _                                   => known.elapsed.toSeconds

  /** The value at one instant of a flight's tracks, which have no ages. */
  def apply(tracks: Tracks, instant: Int, values: Array[Double]): Double = at(values):
    case PolicyInput.Position(vehicle, axis) => tracks.positionNed(vehicle, instant).component(axis)
    case PolicyInput.Velocity(vehicle, axis) => tracks.velocityNed(vehicle, instant).component(axis)
    case _                                   => tracks.timeS(instant)

  /** The number as a formula; that of a condition is 1 or 0.
    *
    * @param settings names of its parameters
    * @param isLike whether an object has this number
    * @param valuesOf the parameters of such an object
    */
  def formula(settings: Vector[String])(isLike: AnyRef => Boolean)(
      valuesOf: AnyRef => Array[Double]
  ): Formula =
    val number =
      if node.op.isCondition then trace.where(node, trace.const(1), trace.const(0)) else node
    Formula.ofGraph(trace, inputs.map(_.toString), Vector("number" -> number), settings)(isLike)(valuesOf)

  private def at(values: Array[Double])(input: PolicyInput => Double): Double =
    evaluation(inputs.iterator.map(input).toArray, values)(0)
