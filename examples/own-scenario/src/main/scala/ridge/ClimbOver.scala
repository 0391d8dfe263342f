package ridge

import skein.policy.*
import skein.units.*

/** Flies north at a height above the ground ahead, and waits while it would lose sight of the other vehicle:
  * a policy in three dimensions, without a memory.
  *
  * @param laneM its position east, which it keeps
  */
final case class ClimbOver(land: Land, goalM: Double, laneM: Double, aboveM: Double, other: Int)
    extends Policy:
  type Memory = Unit
  def start: Unit = ()

  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    val (here, there) = (seen.own.kinematics.positionNed, seen.vehicles(other).kinematics.positionNed)
    // Height over the highest ground of the next seconds, because the vehicle lags behind its commands.
    val ahead  = (0 to 4).map(metres => land.heightM(here.x + 3.0 * metres)).max
    val climb  = (-here.z - (ahead + aboveM)).max(-3).min(1.5)
    val isLost = land.clearanceM(here, there) < aboveM / 2 && here.x > there.x
    val north  = if isLost then 0 else (goalM - here.x).max(-1).min(seen.cruise.value)
    // Steep ground is climbed before it is crossed.
    val slowed = if climb < -1.5 then north * 0.4 else north
    (Action.Velocity(Vector3(slowed, (laneM - here.y).max(-1).min(1), climb), Yaw.Forward), ())
