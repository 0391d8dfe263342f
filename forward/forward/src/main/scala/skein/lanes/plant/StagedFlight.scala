package skein.lanes.plant

import skein.lanes.policy.{Directions, LaneObservation}
import skein.simd.{BoundFunction, LaneCall}
import skein.simd.LaneFunction.COUNT as WORLDS
import skein.units.eachBelow

/** Flights by one plant's [[PlantStages]], in many worlds whose steps begin and end together. Mutable.
  *
  * @param speedMps speed of a command of length 1
  * @param startX north component of each world's start, m; `startY` is its east component
  */
private[lanes] final class StagedFlight(
    lanes: PlantLanes,
    speedMps: Double,
    startX: Array[Float],
    startY: Array[Float]
):
  import PlantStages.{East, Holds, North, StartX, StartY, Third}
  private val stages               = lanes.stages
  private val parameters           = stages.parametersOf(lanes.plant, speedMps)
  private val (times, firstOfTime) = (stages.times, stages.firstOfTime)
  private val wholeStep            = stages.tell(lanes.plant)(lanes.plant.stepS).map(_.toFloat)

  /** The state from which [[begin]] starts, in rows. */
  val state: Array[Float] = Array.ofDim[Float](lanes.count * WORLDS)

  private val still         = Array.ofDim[Float](WORLDS)
  private val begun, atRest = Array.ofDim[Float](stages.kept * WORLDS)
  private val next          =
    if stages.isKeptInPlace then begun else Array.ofDim[Float](stages.kept * WORLDS)
  private val acted     = Vector(North, East, Third, Holds).map(stages.act.place).toArray
  private val begins    = Vector(North, East, Third, Holds).map(stages.begin.place).toArray
  private val beginning = bound(stages.begin, state, begun)
  private var moving    = Moving(begun, next)
  private var other     = Moving(next, begun)
  private val resting   = bound(stages.begin, state, atRest)
  lanes.rest(state, 0)

  private var worlds = WORLDS

  /** Limits the simulation to the first worlds, until the next call. */
  def use(worlds: Int): Unit =
    this.worlds = worlds
    for call <- Vector(beginning, resting) ++ moving.calls ++ other.calls do call.use(worlds)

  /** The calls that start from one of two arrays of stored values; they write the next step's values to the
    * other array, or overwrite this one.
    */
  private final class Moving(val kept: Array[Float], to: Array[Float]):
    val position: LaneCall = bound(stages.position, kept)
    val look: LaneCall     = bound(stages.look, kept)
    val act: LaneCall      = bound(stages.act, kept, to)
    val goOn: LaneCall     = bound(stages.goOn, kept, to)
    lazy val end: LaneCall = bound(stages.end, kept)
    def calls              = Vector(position, look, act, goOn)

  private def bound(of: BoundFunction, rows: Array[Float], to: Array[Float] = null): LaneCall =
    val call = LaneCall(of, parameters)
    for (input, place) <- of.inputs.zipWithIndex do
      input match
        case StartX                       => call.input(place, startX, 0)
        case StartY                       => call.input(place, startY, 0)
        case North | East | Third | Holds => call.input(place, still, 0)
        case _                            => call.input(place, rows, 0)
    if to != null then call.output(0, to, 0)
    call

  /** Sets one world's vehicle to its start, at rest, where it stays until the next command. */
  def rest(world: Int): Unit =
    resting()
    for at <- world until atRest.length by WORLDS do moving.kept(at) = atRest(at)

  /** Begins the first step, under a command.
    *
    * @param from index of the first world's command
    */
  def begin(commanded: Directions, from: Int): Unit =
    if moving.kept ne begun then turnOver()
    command(beginning, begins, commanded, from)
    beginning()

  /** Begins the next step at the present moment, under a command. */
  def act(commanded: Directions, from: Int): Unit =
    command(moving.act, acted, commanded, from)
    moving.act()
    turnOver()

  private def command(call: LaneCall, places: Array[Int], commanded: Directions, from: Int): Unit =
    call.inputIfAny(places(0), commanded.cos, from)
    call.inputIfAny(places(1), commanded.sin, from)
    if lanes.inSpace then
      call.inputIfAny(places(2), commanded.third, from)
      call.inputIfAny(places(3), commanded.holds, from)

  /** Simulates up to a time.
    *
    * @param time array that represents the time from index `at` on: the number of steps that end until then,
    *   and the values of the time since the last step
    */
  def flyTo(time: Array[Float], at: Int): Unit =
    eachBelow(time(at).toInt): _ =>
      tell(wholeStep, 0)
      moving.goOn()
      turnOver()
    tell(time, at + 1)

  private def tell(time: Array[Float], at: Int): Unit =
    eachBelow(times): i =>
      parameters(firstOfTime + i) = time(at + i)

  private def turnOver(): Unit =
    val before = moving
    moving = other
    other = before

  /** Writes the present position and, if it is wanted or the flight is in space, velocity.
    *
    * @param seen by component of a reading ([[LaneObservation]])
    * @param into index of the first world
    */
  def look(seen: Array[Array[Float]], into: Int, withVelocity: Boolean): Unit =
    val look = if withVelocity || lanes.inSpace then moving.look else moving.position
    eachBelow(LaneObservation.count(withVelocity, lanes.inSpace))(i => look.output(i, seen(i), into))
    look()

  /** Writes the present state in rows.
    *
    * @param at index of the first row
    */
  def end(into: Array[Float], at: Int): Unit =
    val end = moving.end
    end.use(worlds)
    end.output(0, into, at)
    end()
