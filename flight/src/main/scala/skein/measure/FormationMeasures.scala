package skein.measure

import skein.policy.TeamScenario

/** How well followers keep their slots behind the first vehicle, their leader. */
object FormationMeasures:

  /** For the vehicles to get under way; not counted. */
  val settlingS = 10.0

  def apply(scenario: TeamScenario.Formation, track: TeamTrack): TeamResult =
    val errors  = track.instants.map(slotErrorsM(scenario, track, _))
    val settled = track.instants.filter(track.timeS(_) >= settlingS)
    val counted = if settled.isEmpty then track.instants else settled
    val worst   = counted.maxBy(errors(_).max)
    TeamResult(
      scenario,
      track,
      Vector(
        Measure("slot rms m", Some(rms(counted.flatMap(errors)))),
        Measure("largest m", Some(errors(worst).max)),
        Measure("at s", Some(track.timeS(worst)))
      ),
      "slot error, rms",
      track.curve(instant => rms(errors(instant))),
      None
    )

  /** From each follower to its slot in the frame along the circuit where the leader is, m. */
  def slotErrorsM(scenario: TeamScenario.Formation, track: TeamTrack, instant: Int): Vector[Double] =
    val (north, east) = (track.northM(0)(instant), track.eastM(0)(instant))
    val circuit       = scenario.circuit
    val heading       = circuit.headingRad(circuit.nearest(north, east))
    val (cos, sin)    = (StrictMath.cos(heading), StrictMath.sin(heading))
    scenario.slots.zip(track.vehicles.tail).map:
      case ((ahead, right), follower) =>
        track.distanceM(
          follower,
          north + ahead * cos - right * sin,
          east + ahead * sin + right * cos,
          instant
        )

  private def rms(values: Seq[Double]): Double =
    math.sqrt(values.map(value => value * value).sum / values.size)
