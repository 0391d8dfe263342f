package skein.lanes.plant

import skein.formula.{Formula, Node, Trace}
import skein.simd.{BoundFunction, LaneCall}
import skein.vehicle.Plant

/** A plant's steps of equal duration, in worlds whose steps begin together, with a reading after each step.
  * Compiled once for all plants of a form.
  *
  * @param places indices of the state's components that initially equal the vehicle's start, north and east;
  *   None if there are none
  */
private[skein] final class PlantSteps private[lanes] (
    stepping: Formula,
    reading: Formula,
    val places: Option[Vector[Int]]
):
  private val trace       = Trace()
  private val count       = stepping.outputs.size
  private val expressions = PlantExpressions(
    trace,
    stepping,
    reading,
    first = 1,
    trace.input,
    trace.input(count),
    trace.input(count + 1),
    trace.param(0),
    Vector.empty
  )
  private val seen =
    if places.isDefined then expressions.seen
    else expressions.seenFrom(trace.input(count + 2), trace.input(count + 3))

  /** Whether the state consists of exactly the reading's components, in their order. */
  val isRead: Boolean = seen == expressions.stepped

  private lazy val ofState   = bound(expressions.stepped)
  private lazy val ofReading = bound(expressions.stepped ++ seen)

  private def bound(of: Vector[Node]) =
    BoundFunction.of(of, { case number if number < count => number }, areRows = true)

  /** Prepares calls with a plant's parameters.
    *
    * @param spanS duration of each step
    * @param reads whether outputs include position and velocity, north and east, in rows after the state
    */
  def call(plant: Plant[?], spanS: Double, reads: Boolean): PlantSteps.Call =
    val parameters = (spanS +: expressions.parametersOf(plant, 0)).map(_.toFloat)
    PlantSteps.Call(if reads then ofReading else ofState, parameters, count)

private[skein] object PlantSteps:
  final class Call private[lanes] (stepped: BoundFunction, parameters: Array[Float], count: Int):
    private val call  = LaneCall(stepped, parameters)
    private val state = stepped.inputs.indexWhere(_ < count)
    private val north = stepped.place(count)
    private val east  = stepped.place(count + 1)

    /** Sets where the state at the start of a step is read.
      *
      * @param apart distance between the rows of successive steps; after the array's last rows the first rows
      *   follow
      */
    def rows(array: Array[Float], from: Int, apart: Int): Unit = call.inputIfAny(state, array, from, apart)

    /** Sets where the state at the end of a step is written. */
    def outputRows(array: Array[Float], from: Int, apart: Int): Unit = call.output(0, array, from, apart)

    def starts(north: Array[Float], east: Array[Float]): Unit =
      call.inputIfAny(stepped.place(count + 2), north)
      call.inputIfAny(stepped.place(count + 3), east)

    /** Sets the command for all further steps: components divided by the speed, and the speed, m/s. */
    def command(north: Array[Float], east: Array[Float], speed: Float): Unit =
      parameters(1) = speed
      call.inputIfAny(this.north, north)
      call.inputIfAny(this.east, east)

    def next(): Unit = call.next()

    def rewind(): Unit = call.rewind()
