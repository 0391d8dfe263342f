package skein.environment

import skein.policy.Role
import skein.signal.SplitMix64

/** The vehicles' positions at rest when an episode begins, north and east, m, and their assumed commanded
  * headings. Mutable.
  */
private final class Starts(side: LearnerSide):
  private val agents        = side.engagement.agents
  private val (least, most) = side.settings.startWithinM

  val northM: Array[Float]     = agents.map(_.startX.toFloat).toArray
  val eastM: Array[Float]      = agents.map(_.startY.toFloat).toArray
  val headingRad: Array[Float] = agents.map(_.startHeadingRad.toFloat).toArray

  /** With two vehicles, the index of the vehicle from which the other vehicle's distance is measured. */
  private val centre = side.engagement.roles.indexOf(Role.Pursuer).max(0)

  /** Draws the starts of an episode, see [[EnvironmentSettings.startWithinM]]. */
  def draw(seed: Long): Unit =
    if most > 0 then
      val random = SplitMix64(seed)
      if agents.size == 2 then
        def angle() = (2 * random.nextDouble() - 1) * math.Pi
        around(1 - centre, centre, least + random.nextDouble() * (most - least), angle())
        headingRad(1 - centre) = angle().toFloat
        headingRad(centre) = angle().toFloat
      else
        for vehicle <- agents.indices do
          val distanceM = least + random.nextDouble() * (most - least)
          around(vehicle, vehicle, distanceM, 2 * math.Pi * random.nextDouble())

  private def around(vehicle: Int, of: Int, distanceM: Double, bearingRad: Double): Unit =
    northM(vehicle) = (agents(of).startX + distanceM * StrictMath.cos(bearingRad)).toFloat
    eastM(vehicle) = (agents(of).startY + distanceM * StrictMath.sin(bearingRad)).toFloat

  /** Distance of a vehicle from its nearest opponent, in space if learners climb, m. */
  def distanceM(vehicle: Int): Float =
    side.rivals(vehicle).map: other =>
      val level = StrictMath.hypot(northM(vehicle) - northM(other), eastM(vehicle) - eastM(other))
      val downM = agents(vehicle).altitudeDownM - agents(other).altitudeDownM
      (if side.settings.space.climbs then StrictMath.hypot(level, downM) else level).toFloat
    .min
