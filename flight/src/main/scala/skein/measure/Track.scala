package skein.measure

import skein.policy.Role
import skein.record.Recording
import skein.units.*

/** Where one vehicle was, by the simulator's clock; ascending, each instant once. */
final case class Track private (
    vehicle: String,
    role: String,
    times: Vector[Instant],
    positionsNed: Vector[Vector3]
):
  def from: Instant = times.head
  def to: Instant   = times.last

  def isA(role: Role): Boolean = Role.parse(this.role).contains(role)

  /** On straight lines between samples. A vehicle that circles at 10 m/s on 8 m, seen every 100 ms, is less than
    * 2 cm from them. Outside the track's times, its first or last position.
    */
  def at(time: Instant): Vector3 =
    val above = times.search(time).insertionPoint
    if above == 0 then positionsNed.head
    else if above == times.size then positionsNed.last
    else
      val share = time.since(times(above - 1)).toSeconds / times(above).since(times(above - 1)).toSeconds
      positionsNed(above - 1) + (positionsNed(above) - positionsNed(above - 1)) * share

object Track:

  /** The track of every vehicle that was seen: from the recorded truth, if there is any, else from the readings. */
  def of(recording: Recording): Vector[Track] =
    val truths   = recording.truths.map(truth => (truth.vehicle, truth.validAt, truth.positionNed))
    val readings = recording.readings.map: reading =>
      (reading.vehicle, reading.state.validAt, reading.state.value.positionNed)
    val samples = (if truths.nonEmpty then truths else readings).groupBy(_._1)
    for
      vehicle <- recording.heading.vehicles.toVector
      seen    <- samples.get(vehicle.name)
    yield
      val ordered = seen.distinctBy(_._2).sortBy(_._2)
      Track(
        vehicle.name,
        vehicle.role.toLowerCase(java.util.Locale.ROOT),
        ordered.map(_._2),
        ordered.map(_._3)
      )
