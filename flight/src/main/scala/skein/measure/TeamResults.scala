package skein.measure

import skein.policy.TeamScenario
import skein.record.Recording

/** What teams' recorded flights came to. */
object TeamResults:

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
