package skein.simulator

import skein.airsim.wire.*

/** Functions of Cosys-AirSim's clients (version 3) that differ from AirSim's: some have other parameters,
  * some are additional. Those that need assets, layers, lights or sensors that do not exist here answer as
  * for an unknown name.
  */
private[simulator] object CosysMethods extends MethodList:
  import ServerMethod.*

  one[String]("getComputerVisionState"): (simulation, name) =>
    vehicle(simulation, name): (_, vehicle) =>
      if !vehicle.settings.isCamera then
        CallOutcome.Threw(s"expected a camera, '${vehicle.settings.name}' is a ${vehicle.kind}")
      else
        val now = simulation.world.now
        answer(ComputerVisionState(VehicleMethods.kinematics(vehicle, now), now))
  read("simGetPhysicsRawKinematics", simulated)(VehicleMethods.kinematics)
  many[(KinematicsState, String)]("simSetPhysicsRawKinematics"):
    case (simulation, (state, name)) => SceneMethods.setKinematics(simulation, state, name)
  none("simListInstanceSegmentationObjects")(simulation => answer(simulation.objects.names))
  many[(Boolean, Boolean)]("simListInstanceSegmentationPoses"):
    case (simulation, (ned, onlyVisible)) =>
      if onlyVisible then CallOutcome.Threw("poses are available of all objects, not only of visible ones")
      else inNed(ned)(answer(simulation.objects.names.map(simulation.objects.poseOf)))
  one[String]("simListSceneObjectsTags"): (_, regex) =>
    NamePattern(regex): Unit
    answer(Seq.empty[String])
  one[Vector3r]("simSetExtForce"): (_, _) =>
    CallOutcome.Threw("the built-in simulator has no external forces")
  sensorPose("simSetLidarPose", "lidar")
  sensorPose("simSetDistanceSensorPose", "distance sensor")
  sensorPose("simSetEchoPose", "echo")
  sensorPose("simSetGPULidarPose", "gpulidar")
  sensor("getEchoData", "echo")
  sensor("getGPULidarData", "gpulidar")
  sensor("getUWBData", "uwb")
  sensor("getUWBSensorData", "uwb")
  sensor("getWifiData", "wifi")
  sensor("getWifiSensorData", "wifi")
  many[(String, Float)]("simSetWorldLightIntensity")((_, _) => answer(false))
  many[(String, Boolean)]("simSetWorldLightVisibility")((_, _) => answer(false))
  many[(String, String, Float)]("simSetVehicleLightIntensity")((_, _) => answer(false))
  many[(String, String, Boolean)]("simSetVehicleLightVisibility")((_, _) => answer(false))
  one[String]("simListAnnotationObjects")((_, _) => answer(Seq.empty[String]))
  many[(String, Boolean, Boolean)]("simListAnnotationPoses")((_, _) => answer(Seq.empty[Pose]))
  many[(String, String, Int, Boolean)]("simSetAnnotationObjectID")((_, _) => answer(false))
  many[(String, String, Int, Int, Int, Boolean)]("simSetAnnotationObjectColor")((_, _) => answer(false))
  many[(String, String, Float, Boolean)]("simSetAnnotationObjectValue")((_, _) => answer(false))
  many[(String, String, String, Boolean)]("simSetAnnotationObjectTextureByPath")((_, _) => answer(false))
  many[(String, String, Boolean)]("simEnableAnnotationObjectTextureByPath")((_, _) => answer(false))
  annotation("simGetAnnotationObjectID")
  annotation("simGetAnnotationObjectColor")
  annotation("simGetAnnotationObjectValue")
  annotation("simGetAnnotationObjectTexturePath")

  /** Variants of functions that AirSim's clients call, too: camera functions lack `external` and have an
    * annotation's name where an image type is named; object poses have an argument `ned`.
    */
  def forms: Seq[ServerMethod] = Forms.all

  private object Forms extends MethodList:
    for method <- CameraMethods.all do
      add(method.closing(false, Option.when(OfImages(method.name))(summon[Argument[String]])))
    many[(String, Boolean)]("simGetObjectPose"):
      case (simulation, (name, ned)) => inNed(ned)(answer(simulation.objects.poseOf(name)))

  private val OfImages = Set(
    "simGetImage",
    "simGetDetections",
    "simAddDetectionFilterMeshName",
    "simSetDetectionFilterRadius",
    "simClearDetectionMeshNames"
  )

  private def inNed(ned: Boolean)(run: => CallOutcome): CallOutcome =
    if ned then run
    else CallOutcome.Threw("poses are available in NED alone: there are no Unreal coordinates")

  private def sensor(method: String, kind: String): Unit =
    many[(String, String)](method):
      case (simulation, (sensor, name)) =>
        vehicle(simulation, name)((_, _) => VehicleMethods.missing(kind, sensor))

  /** A setter of a sensor's pose, which always fails: sensors stay as configured. */
  private def sensorPose(method: String, kind: String): Unit =
    many[(String, Pose, String)](method):
      case (simulation, (sensor, _, name)) =>
        vehicle(simulation, name): (_, vehicle) =>
          val own = vehicle.settings
          if kind == "lidar" && simulation.equipment.lidar(own, sensor).nonEmpty ||
            kind == "distance sensor" && simulation.equipment.ranger(own, sensor).nonEmpty
          then CallOutcome.Threw("sensors stay where the settings put them")
          else VehicleMethods.missing(kind, sensor)

  private def annotation(method: String): Unit =
    many[(String, String)](method):
      case (_, (layer, _)) => CallOutcome.Threw(s"No annotation layer with name $layer exist")
