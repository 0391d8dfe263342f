package skein.lanes.gpu

import skein.gpu.{Ptx, PtxExpressions, Variables}
import skein.lanes.plant.{PlantLanes, PlantStages}
import skein.simd.BoundFunction

/** A flight by the [[PlantStages]] of one plant in the world of each thread; see
  * [[skein.lanes.plant.StagedFlight]].
  *
  * @param speedMps speed of a command of length 1
  * @param startX register of the start's north component, m; `startY` likewise
  */
private[lanes] final class GpuStages(
    code: Ptx,
    lanes: PlantLanes,
    speedMps: Double,
    startX: Int,
    startY: Int
):
  import PlantStages.{East, Kept, North, StartX, StartY, State}
  private val stages    = lanes.stages
  private val own       = stages.parametersOf(lanes.plant, speedMps)
  private val wholeStep = stages.tell(lanes.plant)(lanes.plant.stepS).map(_.toFloat)
  private val kept      = Variables(code, Seq.fill(stages.kept)(0f))

  def start(): Unit = kept.start()

  /** Begins the first step, under a command.
    *
    * @param state register of each component of the state
    */
  def begin(north: Int, east: Int, state: Int => Int): Unit =
    kept.take(write(stages.begin, north, east, constantTime, state))

  /** Begins the next step under a command.
    *
    * @param time register of each value that represents the time since the start of the present step
    */
  def act(north: Int, east: Int, time: Int => Int): Unit = kept.take(write(stages.act, north, east, time))

  /** Simulates whole steps under the present command. */
  def goOn(steps: Int): Unit =
    code.repeat(steps)(kept.take(write(stages.goOn, Nowhere, Nowhere, constantTime)))

  /** Position and, if requested, velocity during the present step.
    *
    * @param time register of each value that represents the time since the start of the step
    */
  def look(withVelocity: Boolean, time: Int => Int): Vector[Int] =
    write(if withVelocity then stages.look else stages.position, Nowhere, Nowhere, time)

  private val constantTime: Int => Int = number => code.constant(wholeStep(number))

  private def write(
      of: BoundFunction,
      north: Int,
      east: Int,
      time: Int => Int,
      state: Int => Int =
        number => throw IllegalStateException(s"a step goes on without the state's number $number")
  ): Vector[Int] =
    PtxExpressions.write(code, of.nodes)(
      of.inputs(_) match
        case StartX                 => startX
        case StartY                 => startY
        case North                  => north
        case East                   => east
        case input if input >= Kept => kept(input - Kept)
        case input                  => state(input - State)
      ,
      number =>
        if number < stages.firstOfTime then code.constant(own(number)) else time(number - stages.firstOfTime)
    )

  private inline val Nowhere = -1
