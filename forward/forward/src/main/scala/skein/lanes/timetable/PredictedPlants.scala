package skein.lanes.timetable

import java.util.Arrays
import skein.lanes.plant.{PlantCorrection, PlantLanes, StagedFlight}
import skein.lanes.policy.{Directions, LaneObservation}
import skein.units.eachBelow

/** Predicts with a plant. For each command, the propagation has the number of steps that end under it, and
  * the numbers of the time after the last step ([[skein.lanes.plant.PlantStages]]). If readings lack a part
  * of the state, that part is simulated from reading to reading. The scalar reference is
  * [[skein.vehicle.PlantModel]], in space [[skein.vehicle.SpatialModel]].
  *
  * @param correction corrects the state with a reading
  * @param speedMps speed of a command of length 1
  */
private[lanes] final class PredictedPlants(
    lanes: PlantLanes,
    correction: PlantCorrection,
    speedMps: Double
) extends PredictedVehicles:
  import PredictedVehicles.WORLDS
  private val origin  = Array.ofDim[Float](WORLDS)
  private val flight  = StagedFlight(lanes, speedMps, origin, origin)
  private val still   = Directions(WORLDS, lanes.inSpace)
  private val correct = correction.call
  private val count   = lanes.count
  private val restZ   = Array.ofDim[Float](WORLDS)

  private val components = LaneObservation.count(true, lanes.inSpace)

  /** The state at each reading, by the reading's slot; used only if readings lack a part of the state. */
  private var states = Array.emptyFloatArray
  private val before = Array.ofDim[Float](count * WORLDS)
  correct.inputs(0, count, before, 0)

  override def start(worlds: Int, startZ: Array[Float]): Unit =
    flight.use(worlds)
    correct.use(worlds)
    if lanes.inSpace then
      System.arraycopy(startZ, 0, restZ, 0, WORLDS)
      still.level(restZ)

  /** Writes the state before the first reading. */
  private def rest(): Unit =
    if lanes.inSpace then lanes.restInSpace(before, 0, restZ) else lanes.rest(before, 0)

  override def enter(
      seen: Array[Array[Float]],
      sent: Directions,
      from: Int,
      reading: Int,
      propagation: Propagation
  ): Unit =
    val needed = seen(LaneObservation.X).length * count
    if states.length < needed then states = Arrays.copyOf(states, needed)
    if from < 0 then
      // Before its first command the vehicle is assumed to hold the altitude of its first reading.
      if lanes.inSpace then
        System.arraycopy(seen(LaneObservation.DOWN), reading, restZ, 0, WORLDS)
        still.level(restZ)
      rest()
    else
      System.arraycopy(states, from * count, flight.state, 0, flight.state.length)
      if fly(sent, propagation) then flight.end(before, 0)
      else System.arraycopy(flight.state, 0, before, 0, before.length)
    take(seen, reading, states, reading * count)

  override def restart(world: Int, seen: Array[Array[Float]]): Unit =
    val state = Array.ofDim[Float](before.length)
    if lanes.inSpace && seen(LaneObservation.DOWN).length > 0 then
      restZ(world) = seen(LaneObservation.DOWN)(world)
      still.level(world, WORLDS, restZ(world))
    rest()
    for reading <- 0 until states.length by state.length do
      take(seen, reading / count, state, 0)
      for at <- world until state.length by WORLDS do states(reading + at) = state(at)

  def predict(
      seen: Array[Array[Float]],
      sent: Directions,
      reading: Int,
      into: Int,
      propagation: Propagation,
      withVelocity: Boolean
  ): Unit =
    if correction.isTold then take(seen, reading, flight.state, 0)
    else System.arraycopy(states, reading * count, flight.state, 0, flight.state.length)
    if !fly(sent, propagation) then
      eachBelow(components)(i => System.arraycopy(seen(i), reading, seen(i), into, WORLDS))
    else flight.look(seen, into, withVelocity)

  /** Corrects the simulated state with a reading. */
  private def take(seen: Array[Array[Float]], reading: Int, into: Array[Float], at: Int): Unit =
    eachBelow(components)(i => correct.input(count + i, seen(i), reading))
    correct.outputs(count, into, at)
    correct()

  /** Simulates from the flight's present state; returns false if no time passes. */
  private def fly(sent: Directions, propagation: Propagation): Boolean =
    val (commands, perPart) = (propagation.commands, propagation.perPart)
    eachBelow(commands.length): i =>
      val command   = commands(i)
      val commanded = if command == Propagation.Rest then still else sent
      val from      = command.max(0) * WORLDS
      if i == 0 then flight.begin(commanded, from) else flight.act(commanded, from)
      flight.flyTo(propagation.numbers, i * perPart)
    commands.length > 0
