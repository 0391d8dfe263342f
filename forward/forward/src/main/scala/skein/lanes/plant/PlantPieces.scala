package skein.lanes.plant

import skein.formula.{Formula, Node, Trace}
import skein.simd.BoundFunction
import skein.vehicle.PlantTiming

/** A plant's motion during one step, in worlds whose steps begin at different times. Compiled once for all
  * plants of a form. The stored components of a step are: the command north and east, divided by the speed,
  * and in space its vertical part; the state at the start of the step; and the vehicle's start, unless the
  * state contains it. A command of −∞ north makes a vehicle rest; one of NaN makes its state NaN, as in the
  * scalar engine.
  *
  * @param places indices of the state's components that initially equal the vehicle's start, north and east;
  *   None if there are none
  */
private[lanes] final class PlantPieces(
    stepping: Formula,
    reading: Formula,
    places: Option[Vector[Int]],
    inSpace: Boolean
):
  import PlantPieces.*

  private val trace = Trace()
  private val count = stepping.outputs.size

  val firstOfState: Int = if inSpace then 4 else 2

  private val expressions =
    val (since, stepS) = (trace.input(Since), trace.param(0))
    val north          = trace.input(North)
    // A plant's step must not be 0 s; the result of this step is not used.
    val rests = trace.equal(north, trace.const(Rests.toDouble))
    val flies = trace.lt(trace.const(0), trace.where(rests, trace.const(0), since))
    PlantExpressions(
      trace,
      stepping,
      reading,
      first = 1,
      number => trace.input(firstOfState + number),
      north,
      trace.input(East),
      trace.where(trace.lt(since, stepS), since, stepS),
      if inSpace then Vector(trace.input(Third), trace.input(Holds)) else Vector.empty,
      _.zipWithIndex.map((node, number) => trace.where(flies, node, trace.input(firstOfState + number)))
    )

  val kept: Int = firstOfState + count + (if places.isDefined then 0 else 2)

  /** Rows of the stored components that initially equal the vehicle's start, north and east. */
  val starts: Array[Int] = places.getOrElse(Vector(count, count + 1)).map(firstOfState + _).toArray

  private val seen =
    if places.isDefined then expressions.seen
    else expressions.seenFrom(trace.input(starts(0)), trace.input(starts(1)))

  /** Computes the state after a time since the start of the step, row by row. */
  val flown: BoundFunction = bound(expressions.stepped)

  /** Computes the position after that time: north and east, in space also down. In space each output has its
    * own array.
    */
  val position: BoundFunction = bound(seen.take(2) ++ seen.drop(4).take(1), areRows = !inSpace)

  /** Computes position and velocity after that time: north and east, in space also down. */
  val look: BoundFunction = bound(seen)

  private def bound(of: Vector[Node], areRows: Boolean = true) =
    BoundFunction.of(of, { case row if row < Since => row }, areRows)

  def parametersOf(plant: PlantTiming, speedMps: Double): Array[Float] =
    (plant.stepS +: expressions.parametersOf(plant, speedMps)).map(_.toFloat)

private[lanes] object PlantPieces:
  /** Inputs of the expressions: the stored components, by row, and the time since the start of the step, s.
    */
  val North: Int = 0

  /** The command north of a vehicle that rests. */
  val Rests: Float = Float.NegativeInfinity
  val East: Int    = 1
  val Third: Int   = 2
  val Holds: Int   = 3
  val Since: Int   = 1 << 16
