package skein.lanes.plant

import skein.formula.{Angles, Evaluation, Formula, Fused, Node, Trace}
import skein.vehicle.PlantTiming

/** A plant's step, and the reading at its end, as expressions. Their parameters are the speed of a command of
  * length 1, then the plant's own parameters.
  *
  * @param first index of the first parameter
  * @param state the state's components at the start of the step
  * @param north the command's component north, divided by the speed
  * @param vertical the third component of a command in space, and whether that is an altitude
  * @param spanS duration of the step
  * @param taken transforms the components of the final state before they are read
  */
private[lanes] final class PlantExpressions(
    trace: Trace,
    stepping: Formula,
    reading: Formula,
    first: Int,
    state: Int => Node,
    north: Node,
    east: Node,
    spanS: Node,
    vertical: Vector[Node],
    taken: Vector[Node] => Vector[Node] = identity
):
  private val count   = stepping.outputs.size
  private val speed   = trace.param(first)
  private val stepOwn = angles(stepping, first + 1, leafOfStep)

  val stepped: Vector[Node] = taken(converted(stepping, stepOwn))

  private val readOwn = angles(reading, first + 1 + stepOwn.derived.size, stepped)

  /** Position and velocity at the end of the step: north and east, and in space also down. */
  val seen: Vector[Node] = converted(reading, readOwn)

  /** [[seen]] with the vehicle's start added to the position. */
  def seenFrom(startX: Node, startY: Node): Vector[Node] =
    Vector(trace.add(seen(0), startX), trace.add(seen(1), startY)) ++ seen.drop(2)

  val parameters: Int = 1 + stepOwn.derived.size + readOwn.derived.size

  private def converted(formula: Formula, angles: Angles) =
    Fused(formula.trace, formula.outputs.map(_._2)).nodes.map(angles.convert)

  private def angles(formula: Formula, from: Int, leaf: Int => Node) =
    Angles(formula.trace, trace, leaf, _ => None, number => trace.param(from + number))

  private def leafOfStep(input: Int) =
    if input < count then state(input)
    else if input < count + 2 then trace.mul(if input == count then north else east, speed)
    else if input < count + 2 + vertical.size then vertical(input - count - 2)
    else spanS

  def parametersOf(plant: PlantTiming, speedMps: Double): Array[Double] =
    speedMps +: (Evaluation(stepOwn.derived)(Array.emptyDoubleArray, stepping.parametersOf(plant)) ++
      Evaluation(readOwn.derived)(Array.emptyDoubleArray, reading.parametersOf(plant)))
