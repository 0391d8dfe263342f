package skein.lanes.timetable

import java.util.Arrays
import skein.forward.RolloutAgent
import skein.lanes.plant.{PlantLanes, StagedFlight}
import skein.lanes.policy.{Directions, LaneObservation}

/** Vehicles that move according to a [[skein.vehicle.Plant]]. Their clock represents a time by the number of
  * steps that end before it, and by the numbers of the time since the last step, as
  * [[skein.lanes.plant.PlantStages]] needs them. The scalar reference is `skein.forward.PlantVehicle`.
  *
  * @param amongClimbers whether commands and readings have a vertical part, even if the plant has none
  */
private[lanes] final class TimetablePlants(agent: RolloutAgent, lanes: PlantLanes, amongClimbers: Boolean)
    extends TimetableVehicles(agent, amongClimbers):
  import LaneObservation.{DOWN, DOWN_MPS, VX, VY, X, Y}
  import TimetableVehicles.WORLDS
  private val flight      = StagedFlight(lanes, agent.speed, startX, startY)
  private val resting     = lanes.resting
  private var isCommanded = false

  def start(worlds: Int): Unit =
    flight.use(worlds)
    if lanes.inSpace then lanes.restInSpace(flight.state, 0, startZ)
    else if amongClimbers then
      for at <- 0 until seen(DOWN).length by WORLDS do System.arraycopy(startZ, 0, seen(DOWN), at, WORLDS)
    isCommanded = false

  def rest(world: Int, headingRad: Float): Unit =
    lanes.face(flight.state, world, headingRad)
    flight.rest(world)

  def look(times: Array[Float], at: Int, into: Int, withVelocity: Boolean): Unit =
    if isCommanded then
      flight.flyTo(times, at)
      flight.look(seen, into, withVelocity)
      // The slot has the errors of an earlier reading.
      if amongClimbers && !lanes.inSpace then lookLevel(into)
    else
      if lanes.inSpace || amongClimbers then lookLevel(into)
      for world <- 0 until WORLDS do
        seen(X)(into + world) = startX(world) + resting.northM.toFloat
        seen(Y)(into + world) = startY(world) + resting.eastM.toFloat
      Arrays.fill(seen(VX), into, into + WORLDS, resting.northMps.toFloat)
      Arrays.fill(seen(VY), into, into + WORLDS, resting.eastMps.toFloat)

  private def lookLevel(into: Int): Unit =
    System.arraycopy(startZ, 0, seen(DOWN), into, WORLDS)
    Arrays.fill(seen(DOWN_MPS), into, into + WORLDS, 0f)

  def act(times: Array[Float], at: Int, commanded: Directions, from: Int): Unit =
    if isCommanded then
      flight.flyTo(times, at)
      flight.act(commanded, from)
    else
      flight.begin(commanded, from)
      isCommanded = true
