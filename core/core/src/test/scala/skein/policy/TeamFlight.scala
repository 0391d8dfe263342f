package skein.policy

/** A team flown by its policies without any delay, each velocity following its command with a first-order
  * lag.
  *
  * @param lagS 0 for velocities that are at once as commanded
  */
final class TeamFlight(scenario: Fleet, lagS: Double, stepS: Double = 0.05):
  private val agents  = scenario.agents
  val northM          = agents.map(_.startPositionNed.x).toArray
  val eastM           = agents.map(_.startPositionNed.y).toArray
  val northMps        = Array.fill(agents.size)(0.0)
  val eastMps         = Array.fill(agents.size)(0.0)
  private val heading = agents.map(_.startHeading.value).toArray

  /** The smallest distance of any two so far, m. */
  var leastM: Double = Double.PositiveInfinity

  def seenBy(vehicle: Int): TeamObservation = TeamObservation(
    vehicle,
    IArray.from(northM),
    IArray.from(eastM),
    IArray.from(northMps),
    IArray.from(eastMps),
    heading(vehicle),
    stepS
  )

  def fly(seconds: Double)(after: => Unit = ()): Unit =
    for _ <- 1 to math.round(seconds / stepS).toInt do
      val courses = agents.indices.map: vehicle =>
        agents(vehicle).policy match
          case team: TeamPolicy => team.course(seenBy(vehicle))
          case _: HeadingPolicy        => throw IllegalArgumentException("no team")
      val share = if lagS == 0 then 1.0 else 1 - math.exp(-stepS / lagS)
      for (course, vehicle) <- courses.zipWithIndex do
        heading(vehicle) = course.headingRad
        northMps(vehicle) += share * (course.speedMps * math.cos(course.headingRad) - northMps(vehicle))
        eastMps(vehicle) += share * (course.speedMps * math.sin(course.headingRad) - eastMps(vehicle))
        northM(vehicle) += northMps(vehicle) * stepS
        eastM(vehicle) += eastMps(vehicle) * stepS
      for one <- agents.indices; other <- 0 until one do leastM = leastM.min(distanceM(one, other))
      after

  def distanceM(one: Int, other: Int): Double =
    math.hypot(northM(one) - northM(other), eastM(one) - eastM(other))
