package skein.measure

import skein.identify.{Detected, Seeing}
import skein.record.Recording
import skein.scene.Placement
import skein.scenario.{Equipment, Scenarios}
import skein.units.*

/** Extracts the detections of the scenario's eyes from a recording, with the ground truth from the target's
  * own readings.
  */
object RecordedSeeing:

  /** One result for each eye with a detection through a camera of its scenario. */
  def of(recording: Recording)(using Scenarios): Vector[Seeing] =
    val summary = FlightSummary.of(recording)
    for
      seen     <- summary.seeing
      images   <- seen.images.toVector
      scenario <- summary.scenario.toVector
      case camera: Equipment.Camera <- scenario.equipment
      if camera.vehicle == seen.eye.vehicle && camera.name == seen.eye.camera
      target <- summary.tracks.find(_.vehicle == seen.eye.target).toVector
    yield
      val across = StrictMath.tan(StrictMath.toRadians(camera.fovDeg) / 2)
      val upward = across * camera.height / camera.width
      val own    = recording.readings.filter(_.vehicle == seen.eye.vehicle).map(_.state)
      val inView = own.count: state =>
        val there =
          Placement(state.value.positionNed, state.value.orientation).inside(target.at(state.validAt))
        there.x > 0 && math.abs(there.y) < across * there.x && math.abs(there.z) < upward * there.x
      Seeing(
        seen.eye.every.toSeconds,
        StrictMath.toRadians(camera.fovDeg),
        seen.eye.workers,
        seen.eye.deadline.toSeconds,
        images,
        inView.toDouble / own.size.max(1),
        seen.detections.map: detection =>
          val there = Placement(detection.cameraNed, detection.orientation).inside(detection.trueNed)
          Detected(
            detection.azimuthRad - StrictMath.atan2(there.y, there.x),
            detection.rangeM,
            there.norm,
            detection.tookMs
          )
      )
