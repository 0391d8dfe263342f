package skein.measure

import skein.record.Recording
import skein.scenario.Track

/** Extracts the vehicles' tracks from a recording. */
object RecordedTracks:

  /** The track of every vehicle that was read: from the recorded true positions, if there are any, else from
    * the readings.
    */
  def of(recording: Recording): Vector[Track] =
    val truths   = recording.truths.groupBy(_.vehicle)
    val readings = if truths.isEmpty then recording.readings.groupBy(_.vehicle) else Map.empty
    for
      vehicle <- recording.heading.vehicles.toVector
      track   <- truths
        .get(vehicle.name)
        .map(seen =>
          Track.ofPositions(vehicle.name, vehicle.role, seen.map(truth => (truth.validAt, truth.positionNed)))
        )
        .orElse(readings.get(vehicle.name).map(seen =>
          Track.of(
            vehicle.name,
            vehicle.role,
            seen.map: reading =>
              val state = reading.state
              (state.validAt, state.value.positionNed, state.value.velocityNed)
          )
        ))
    yield track
