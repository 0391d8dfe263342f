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

  /** One result for each eye with a detection through a camera of its scenario. How many images an eye
    * searched after its last detection is not recorded, so those do not count, nor does a flight without a
    * detection.
    */
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
      val last   = seen.detections.map(_.at).maxOption
      val own    = recording.readings
        .filter(_.vehicle == seen.eye.vehicle)
        .map(_.state)
        .filter(state => last.exists(state.validAt <= _))
      val inViewM = own.flatMap: state =>
        val there =
          Placement(state.value.positionNed, state.value.orientation).inside(target.at(state.validAt))
        Option.when(
          there.x > 0 && math.abs(there.y) < across * there.x && math.abs(there.z) < upward * there.x
        )(there.norm)
      Seeing(
        seen.eye.every.toSeconds,
        StrictMath.toRadians(camera.fovDeg),
        seen.eye.workers,
        seen.eye.deadline.toSeconds,
        images,
        own.size,
        inViewM,
        seen.detections.map: detection =>
          val there = Placement(detection.cameraNed, detection.orientation).inside(detection.trueNed)
          Detected(
            detection.azimuthRad - StrictMath.atan2(there.y, there.x),
            detection.rangeM,
            there.norm,
            detection.tookMs
          )
      )
