package skein.measure

import skein.record.Recording
import skein.scenario.{Eye, Track}
import skein.units.*

/** One detection, with the estimate after it.
  *
  * @param at time of the exposure, on the simulator's clock
  * @param sinceStartS time of the exposure since the start of the flight's readings
  * @param cameraNed the camera's position, m
  * @param orientation the camera's orientation
  * @param azimuthRad measured azimuth, to the right of straight ahead; `elevationRad`: above it
  * @param trueNed the target's position and orientation, by its own readings
  * @param firstUsedMs age at the first decision that used it, if any did
  */
final case class Detection(
    at: Instant,
    sinceStartS: Double,
    cameraNed: Vector3,
    orientation: Quaternion,
    azimuthRad: Double,
    elevationRad: Double,
    rangeM: Double,
    tookMs: Double,
    believedNed: Vector3,
    trueNed: Vector3,
    trueOrientation: Quaternion,
    firstUsedMs: Option[Double]
):
  def errorM: Double = believedNed.horizontalDistance(trueNed)

/** The detections of one of a scenario's eyes.
  *
  * @param images number that was searched until the last detection; absent if nothing was found
  * @param agesMs ages of the detections behind decisions, since the exposure
  */
final case class SeeingSummary(
    eye: Eye,
    detections: Vector[Detection],
    images: Option[Int],
    agesMs: Option[Distribution]
):
  def tookMs: Option[Distribution]  = Distribution.of(detections.map(_.tookMs))
  def errorsM: Option[Distribution] = Distribution.of(detections.map(_.errorM))

  /** Notable detections, each with its name: the first, the closest, the last before the longest gap, and the
    * next one.
    */
  def decisive: Vector[(String, Detection)] =
    val gap = detections.zip(detections.drop(1)).maxByOption((before, next) => next.at.since(before.at))
    Vector(
      detections.headOption.map("first seen" -> _),
      detections.minByOption(_.rangeM).map("closest" -> _),
      gap.map((before, _) => "before it was lost longest" -> before),
      gap.map((_, next) => "seen again" -> next)
    ).flatten

object SeeingSummary:

  /** None if the target's own readings are missing. */
  def of(recording: Recording, eye: Eye, tracks: Vector[Track]): Option[SeeingSummary] =
    val told = recording.measurements
      .filter(row => row.vehicle == eye.vehicle && row.sensor == eye.sensor && row.quantities == Eye.Columns)
    val target  = tracks.find(_.vehicle == eye.target)
    val turned  = recording.readings.filter(_.vehicle == eye.target).sortBy(_.state.validAt)
    val byTime  = turned.map(_.state.validAt)
    val ages    = agesMs(recording, eye)
    val ordered = told.distinctBy(_.validAt).sortBy(_.validAt)
    target.map: track =>
      val detections = ordered.map: row =>
        val v       = row.numbers
        val nearest = turned((byTime.search(row.validAt).insertionPoint - 1).max(0))
        Detection(
          row.validAt,
          row.validAt.since(track.from).toSeconds,
          Vector3(v(11), v(12), v(13)),
          Quaternion(v(14), v(15), v(16), v(17)),
          v(7),
          v(8),
          v(9),
          v(10),
          Vector3(v(0), v(1), v(2)),
          track.at(row.validAt),
          nearest.state.value.orientation,
          ages.get(row.validAt).map(_.min)
        )
      SeeingSummary(
        eye,
        detections.toVector,
        ordered.lastOption.map(_.numbers(18).toInt),
        Distribution.of(ages.values.flatten.toVector)
      )

  /** Ages of the estimates at decisions, by the exposure on which they are based. */
  private def agesMs(recording: Recording, eye: Eye): Map[Instant, Vector[Double]] =
    val validAt = recording.measurements
      .filter(row => row.vehicle == eye.vehicle && row.sensor == eye.sensor)
      .map(row => row.sequence -> row.validAt)
      .toMap
    val decided = recording.decisions
      .filter(_.vehicle == eye.vehicle)
      .map(decision => decision.sequence -> decision)
      .toMap
    recording.sensings
      .filter(sensing => sensing.vehicle == eye.vehicle && sensing.sensor == eye.sensor)
      .toVector
      .flatMap: sensing =>
        for
          decision <- decided.get(sensing.decision)
          exposed  <- validAt.get(sensing.measurement)
          clocks   <- decision.trueAge
        yield exposed -> decision.decidedAt.since(exposed + clocks.clockOffset).toMillis
      .groupMap(_._1)(_._2)
