package skein.simulator

import skein.airsim.wire.*
import skein.rpc.Encoded
import upack.{Binary, Msg}
import upickle.default.writeMsg

/** Functions of cameras and their images, by AirSim's names. */
private[simulator] object CameraMethods extends MethodList:
  import ServerMethod.*

  /** Maximum accepted length, mm; larger than any film or lens. */
  private inline val LargestMm = 100_000f

  many[(String, String, Boolean)]("simGetCameraInfo"):
    case (simulation, (camera, name, external)) =>
      of(simulation, camera, name, external): (index, camera) =>
        val vehicle = simulation.world.vehicles(index)
        answer(
          cameraOf(simulation, index, camera).info(
            vehicle.positionAt(simulation.world.now),
            vehicle.orientation
          )
        )
  many[(String, Pose, String, Boolean)]("simSetCameraPose"):
    case (simulation, (camera, pose, name, external)) =>
      change(simulation, camera, name, external): camera =>
        camera.copy(
          position = pose.position.toVector,
          orientation = pose.orientation.toQuaternion.normalized
        )
  many[(String, Float, String, Boolean)]("simSetCameraFov"):
    case (simulation, (camera, degrees, name, external)) =>
      positive("a field of view", degrees, 179.9f):
        change(simulation, camera, name, external)(_.withFov(degrees))
  many[(String, String, Float, String, Boolean)]("simSetDistortionParam"):
    case (simulation, (camera, parameter, value, name, external)) =>
      val index = Camera.DistortionNames.indexOf(parameter)
      if index < 0 then
        CallOutcome.Threw(
          s"no distortion parameter '$parameter': it is one of ${Camera.DistortionNames.mkString(", ")}"
        )
      else change(simulation, camera, name, external)(_.withDistortion(index, value))
  get("simGetDistortionParams")(camera => answer(camera.distortion))
  get("simGetPresetLensSettings")(_ => answer(Lens.Presets.map(_.text)))
  get("simGetLensSettings")(camera => answer(camera.lens.text))
  preset("simSetPresetLensSettings", Lens.Presets, _.name)(_.withLens(_))
  get("simGetPresetFilmbackSettings")(_ => answer(Filmback.Presets.map(_.text)))
  get("simGetFilmbackSettings")(camera => answer(camera.filmback.text))
  preset("simSetPresetFilmbackSettings", Filmback.Presets, _.name)((camera, filmback) =>
    camera.withFilm(filmback)
  )
  many[(Float, Float, String, String, Boolean)]("simSetFilmbackSettings"):
    case (simulation, (width, height, camera, name, external)) =>
      positive("a sensor's width", width, LargestMm):
        positive("a sensor's height", height, LargestMm):
          val film = Filmback("Custom...", width, height)
          change(simulation, camera, name, external)(_.withFilm(film)) match
            case CallOutcome.Answered(_) => answer(film.aspectRatio)
            case refused                 => refused
  get("simGetFocalLength")(camera => answer(camera.focalLengthMm))
  set("simSetFocalLength", "a focal length", LargestMm)(_.withFocalLength(_))
  get("simGetFocusDistance")(camera => answer(camera.focusDistanceCm))
  set("simSetFocusDistance", "a focus distance", Float.MaxValue)((camera, cm) =>
    camera.copy(focusDistanceCm = cm)
  )
  get("simGetFocusAperture")(camera => answer(camera.apertureF))
  set("simSetFocusAperture", "an aperture", LargestMm)((camera, stop) => camera.copy(apertureF = stop))
  get("simGetCurrentFieldOfView")(camera =>
    answer(
      s"Current Field Of View:\n\tHorizontal Field Of View: ${Lens.plain(camera.fovDeg)};\n\t " +
        s"Vertical Field Of View: ${Lens.plain(camera.verticalFovDeg)}"
    )
  )
  switch("simEnableManualFocus")
  switch("simEnableFocusPlane")
  many[(Seq[ImageRequest], String, Boolean)]("simGetImages"):
    case (simulation, (requests, name, external)) =>
      simulated(simulation, name): (index, _) =>
        if external then CallOutcome.Threw("No external cameras exist")
        else
          drawn(Shots.of(simulation, index, requests))(shots => ImageResponse.encode(shots.take()))
  many[(String, Int, String, Boolean)]("simGetImage"):
    case (simulation, (camera, kind, name, external)) =>
      of(simulation, camera, name, external): (index, camera) =>
        val request = ImageRequest(camera, kind, pixels_as_float = false, compress = true)
        drawn(Shots.of(simulation, index, Seq(request)))(shots =>
          Binary(shots.take().head.image_data_uint8)
        )
  many[(String, Int, String, Boolean)]("simGetDetections"):
    case (simulation, (camera, kind, name, external)) =>
      of(simulation, camera, name, external): (index, camera) =>
        drawn(Shots.kindOf(kind).map(_ => Detections.of(simulation, index, camera, kind))): found =>
          writeMsg(found())
  many[(String, Int, String, String, Boolean)]("simAddDetectionFilterMeshName"):
    case (simulation, (camera, kind, mesh, name, external)) =>
      detecting(simulation, camera, kind, name, external): filter =>
        if mesh.length > DetectionFilter.LongestName then
          Left(s"a mesh's name has at most ${DetectionFilter.LongestName} characters, not ${mesh.length}")
        else if filter.meshes.size < DetectionFilter.MostMeshes then
          Right(filter.copy(meshes = filter.meshes + mesh))
        else Left(s"a detection filter holds at most ${DetectionFilter.MostMeshes} names")
  many[(String, Int, Float, String, Boolean)]("simSetDetectionFilterRadius"):
    case (simulation, (camera, kind, radiusCm, name, external)) =>
      detecting(simulation, camera, kind, name, external)(filter => Right(filter.copy(radiusCm = radiusCm)))
  many[(String, Int, String, Boolean)]("simClearDetectionMeshNames"):
    case (simulation, (camera, kind, name, external)) =>
      detecting(simulation, camera, kind, name, external)(filter => Right(filter.copy(meshes = Set.empty)))

  private def get(method: String)(read: Camera => CallOutcome): Unit =
    many[(String, String, Boolean)](method):
      case (simulation, (camera, name, external)) =>
        of(simulation, camera, name, external)((index, camera) => read(cameraOf(simulation, index, camera)))

  private def set(
      method: String,
      what: String,
      largest: Float
  )(change: (Camera, Float) => Camera): Unit =
    many[(Float, String, String, Boolean)](method):
      case (simulation, (value, camera, name, external)) =>
        positive(what, value, largest):
          CameraMethods.change(simulation, camera, name, external)(change(_, value))

  private def preset[A](
      method: String,
      presets: Seq[A],
      named: A => String
  )(change: (Camera, A) => Camera): Unit =
    many[(String, String, String, Boolean)](method):
      case (simulation, (preset, camera, name, external)) =>
        // As in AirSim, an unknown preset changes nothing.
        CameraMethods.change(simulation, camera, name, external): camera =>
          presets.find(named(_) == preset).fold(camera)(change(camera, _))

  /** A function that is accepted and has no effect: images have no focus here. */
  private def switch(method: String): Unit =
    many[(Boolean, String, String, Boolean)](method):
      case (simulation, (_, camera, name, external)) => of(simulation, camera, name, external)((_, _) => Nil)

  /** Draws outside the simulation once the request is resolved. */
  private def drawn[A](ready: Either[String, A])(take: A => Msg | Encoded): CallOutcome =
    ready.fold(CallOutcome.Threw(_), one => CallOutcome.Draws(() => take(one)))

  private def positive(what: String, value: Float, largest: Float)(run: => CallOutcome): CallOutcome =
    if value > 0 && value <= largest then run
    else CallOutcome.Threw(s"$what is above 0 and at most $largest, not $value")

  private def change(simulation: Simulated, camera: String, name: String, external: Boolean)(
      change: Camera => Camera
  ): CallOutcome =
    of(simulation, camera, name, external): (index, camera) =>
      done(simulation.cameras(index, camera) = change(cameraOf(simulation, index, camera)))

  private def detecting(simulation: Simulated, camera: String, kind: Int, name: String, external: Boolean)(
      change: DetectionFilter => Either[String, DetectionFilter]
  ): CallOutcome =
    of(simulation, camera, name, external): (index, camera) =>
      Shots
        .typeOf(kind)
        .flatMap(_ => change(simulation.cameras.detection(index, camera, kind)))
        .fold(
          CallOutcome.Threw(_),
          filter => done(simulation.cameras.setDetection(index, camera, kind, filter))
        )

  /** Resolves a camera to its vehicle's index and its own name. AirSim crashes on an unknown camera. */
  private def of(simulation: Simulated, camera: String, name: String, external: Boolean)(
      run: (Int, String) => CallOutcome
  ): CallOutcome =
    if external then CallOutcome.Threw(s"No external camera with name $camera exist")
    else
      simulated(simulation, name): (index, vehicle) =>
        simulation.cameras.canonical(vehicle, camera)
          .fold(CallOutcome.Threw(Shots.noCamera(camera)))(run(index, _))

  private def cameraOf(simulation: Simulated, vehicle: Int, camera: String): Camera =
    simulation.cameras(vehicle, simulation.world.vehicles(vehicle), camera)
