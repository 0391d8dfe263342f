package skein.policy

import skein.units.{MetresPerSecond, Radians}

/** Chooses a velocity for one vehicle from what it knows of its whole team. A pure function of its argument;
  * it integrates over elapsed time and never counts its calls.
  */
trait TeamPolicy extends PlanarPolicy:

  /** The horizontal velocity to command now. */
  def course(seen: TeamObservation): Course

  type Memory = Unit

  final def start: Unit = ()

  final def planar(seen: Observation, memory: Unit): (Planar, Unit) =
    val chosen = course(TeamObservation.of(seen))
    (Planar(Radians(chosen.headingRad), Some(MetresPerSecond(chosen.speedMps))), ())

/** A policy of a vehicle with a goal: a planner can decide in its place. */
trait GoalPolicy extends TeamPolicy:

  /** Where it wants to be a time ahead, north and east, m, if it were alone. */
  def wanted(seen: TeamObservation, aheadS: Double): (Double, Double)

  final override def isPlannedFor(role: Role): Boolean = true

  /** The fastest that is commanded, m/s. */
  def mostMps: Double

  /** The smallest separation allowed, m; 0: none. */
  def minimumM: Double = 0

/** What one vehicle knows of its team at one moment. Arrays are by the vehicle's place in the scenario, its
  * own included; world frame NED.
  *
  * @param self the own place
  * @param northM positions, m
  * @param northMps velocities, m/s
  * @param headingRad commanded last to the own vehicle
  * @param elapsedS time since the own last decision; 0 at the first
  */
final case class TeamObservation(
    self: Int,
    northM: IArray[Double],
    eastM: IArray[Double],
    northMps: IArray[Double],
    eastMps: IArray[Double],
    headingRad: Double,
    elapsedS: Double
):
  require(
    northM.length == eastM.length && northM.length == northMps.length && northM.length == eastMps.length,
    "a position and a velocity of every vehicle are needed"
  )

  /** How many vehicles there are. */
  def count: Int = northM.length

object TeamObservation:
  def of(seen: Observation): TeamObservation =
    val all = seen.vehicles.map(_.kinematics)
    TeamObservation(
      seen.self,
      IArray.from(all.map(_.positionNed.x)),
      IArray.from(all.map(_.positionNed.y)),
      IArray.from(all.map(_.velocityNed.x)),
      IArray.from(all.map(_.velocityNed.y)),
      seen.headings(seen.self).value,
      seen.elapsed.toSeconds
    )

/** A horizontal velocity to command.
  *
  * @param headingRad from north towards east
  */
final case class Course(headingRad: Double, speedMps: Double)

object Course:

  /** A velocity as a course, no faster than allowed. One without a direction keeps the heading. */
  def of(northMps: Double, eastMps: Double, mostMps: Double, headingRad: Double): Course =
    val speed = StrictMath.hypot(northMps, eastMps)
    if speed < 1e-9 then Course(headingRad, 0)
    else Course(StrictMath.atan2(eastMps, northMps), speed.min(mostMps))

/** Proportional-derivative control with feed-forward, for a vehicle with a lag that follows a moving point:
  * the point's velocity, plus shares of the errors of position and of velocity.
  *
  * @param perS commanded speed per metre behind
  * @param lead commanded speed per speed behind: 1 halves the time constant of a vehicle that follows its
  *   command with a lag
  */
final case class Pursuit(perS: Double = 0.6, lead: Double = 1.0):

  /** Speed to command on one axis. */
  def along(goalM: Double, goalMps: Double, ownM: Double, ownMps: Double): Double =
    goalMps + perS * (goalM - ownM) + lead * (goalMps - ownMps)
