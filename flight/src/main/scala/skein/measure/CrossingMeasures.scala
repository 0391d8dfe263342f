package skein.measure

import skein.policy.TeamScenario

/** How vehicles cross: how near they come to one another, and how soon they are through. */
object CrossingMeasures:

  /** From its goal, a vehicle counts as arrived. */
  val arrivedM = 3.0

  def apply(scenario: TeamScenario.Crossing, track: TeamTrack): TeamResult =
    val separation = track.instants.map(separationM(track, _))
    val closest    = separation.indices.minBy(separation)
    val arrivals   = arrivalsS(scenario, track)
    TeamResult(
      scenario,
      track,
      Vector(
        Measure("closest m", Some(separation(closest))),
        Measure("at s", Some(track.timeS(closest))),
        Measure("violations", Some(violations(track, scenario.minimumM).toDouble), isCount = true),
        Measure("arrived", Some(arrivals.size.toDouble), isCount = true),
        Measure("to goal s", Option.when(arrivals.nonEmpty)(arrivals.sum / arrivals.size)),
        Measure("per min", arrivals.maxOption.map(arrivals.size / _ * 60))
      ),
      "smallest separation",
      track.curve(separation),
      Some(scenario.minimumM)
    )

  /** Of the two nearest to one another, m. */
  def separationM(track: TeamTrack, instant: Int): Double =
    pairs(track).map(track.distanceM(_, _, instant)).min

  /** How often any two came nearer than a minimum: once for each pair and stretch of time. */
  def violations(track: TeamTrack, minimumM: Double): Int =
    pairs(track)
      .map: (one, other) =>
        val below = track.instants.map(track.distanceM(one, other, _) < minimumM)
        below.zip(false +: below).count((now, before) => now && !before)
      .sum

  /** When vehicles came to their goals, s, for those that did. */
  def arrivalsS(scenario: TeamScenario.Crossing, track: TeamTrack): Vector[Double] =
    for
      (vehicle, (north, east)) <- track.vehicles.toVector.zip(scenario.goals)
      instant                  <- track.instants.find(track.distanceM(vehicle, north, east, _) < arrivedM)
    yield track.timeS(instant)

  private def pairs(track: TeamTrack): Iterator[(Int, Int)] =
    for one <- track.vehicles.iterator; other <- (0 until one).iterator yield (one, other)
