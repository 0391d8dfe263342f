package skein.report

import skein.policy.TeamScenario
import skein.record.Recording

/** What a team's flight came to.
  *
  * @param measures
  *   the first one stands for the flight when it is compared with others
  * @param curve
  *   of `curveName` over time: seconds since all were first seen, and metres
  * @param bound
  *   that the curve is held to, m
  */
final case class TeamResult(
    scenario: TeamScenario,
    track: TeamTrack,
    measures: Vector[Measure],
    curveName: String,
    curve: Vector[(Double, Double)],
    bound: Option[Double]
)

/** One number of a flight.
  *
  * @param name
  *   with its unit
  * @param value
  *   absent where it never came to it
  * @param isCount
  *   of events
  */
final case class Measure(name: String, value: Option[Double], isCount: Boolean = false)

object TeamResult:

  /** None for a duel, for vehicles that were not all seen, and for a scenario that this version does not know. */
  def of(recording: Recording, tracks: Vector[Track]): Option[TeamResult] =
    val name = recording.flight.scenario
    for
      scenario <- TeamScenario.of(name, recording.heading.parametersOf(name)).toOption
      track    <- TeamTrack.of(tracks) if tracks.size == scenario.vehicles
    yield scenario match
      case surround: TeamScenario.Surround   => SurroundMeasures(surround, track)
      case formation: TeamScenario.Formation => FormationMeasures(formation, track)
      case crossing: TeamScenario.Crossing   => CrossingMeasures(crossing, track)
