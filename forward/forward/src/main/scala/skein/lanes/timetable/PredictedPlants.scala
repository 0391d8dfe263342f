package skein.lanes.timetable

import java.util.Arrays
import skein.lanes.plant.{PlantCorrection, PlantLanes, StagedFlight}
import skein.lanes.policy.Directions
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
      read: TimetableReadings,
      sent: Directions,
      from: Int,
      reading: Int,
      propagation: Propagation
  ): Unit =
    val needed = read.seenX.length * count
    if states.length < needed then states = Arrays.copyOf(states, needed)
    if from < 0 then
      // Before its first command the vehicle is assumed to hold the altitude of its first reading.
      if lanes.inSpace then
        System.arraycopy(read.seenZ, reading, restZ, 0, WORLDS)
        still.level(restZ)
      rest()
    else
      System.arraycopy(states, from * count, flight.state, 0, flight.state.length)
      if fly(sent, propagation) then flight.end(before, 0)
      else System.arraycopy(flight.state, 0, before, 0, before.length)
    take(read, reading, states, reading * count)

  override def restart(world: Int, read: TimetableReadings): Unit =
    val state = Array.ofDim[Float](before.length)
    if lanes.inSpace && read.seenZ.length > 0 then
      restZ(world) = read.seenZ(world)
      still.level(world, WORLDS, restZ(world))
    rest()
    for reading <- 0 until states.length by state.length do
      take(read, reading / count, state, 0)
      for at <- world until state.length by WORLDS do states(reading + at) = state(at)

  def predict(
      read: TimetableReadings,
      sent: Directions,
      reading: Int,
      into: Int,
      propagation: Propagation,
      withVelocity: Boolean
  ): Unit =
    import read.*
    if correction.isTold then take(read, reading, flight.state, 0)
    else System.arraycopy(states, reading * count, flight.state, 0, flight.state.length)
    if !fly(sent, propagation) then
      for seen <- Array(seenX, seenY, seenVx, seenVy) do System.arraycopy(seen, reading, seen, into, WORLDS)
      if lanes.inSpace then
        for seen <- Array(seenZ, seenVz) do System.arraycopy(seen, reading, seen, into, WORLDS)
    else flight.look(seenX, seenY, seenVx, seenVy, seenZ, seenVz, into, withVelocity)

  /** Corrects the simulated state with a reading. */
  private def take(read: TimetableReadings, reading: Int, into: Array[Float], at: Int): Unit =
    correct.input(count, read.seenX, reading)
    correct.input(count + 1, read.seenY, reading)
    correct.input(count + 2, read.seenVx, reading)
    correct.input(count + 3, read.seenVy, reading)
    if lanes.inSpace then
      correct.input(count + 4, read.seenZ, reading)
      correct.input(count + 5, read.seenVz, reading)
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
