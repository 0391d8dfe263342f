package skein.simulator

import scala.language.implicitConversions
import skein.airsim.VehicleSettings
import skein.airsim.wire.*
import upack.*
import upickle.default.writeMsg

/** One valid call of each function. */
private[simulator] object SampleCalls:

  /** The answer of a fresh simulator with one vehicle to the function's sample call; for a move, when it
    * ends.
    */
  def answered(name: String): Either[String, Msg] =
    val bench =
      if name.contains("Car") then Bench.of(VehicleSettings("Evader", vehicleType = "PhysXCar"))
      else if name.contains("ComputerVision") then
        Bench.of(VehicleSettings("Evader", vehicleType = "ComputerVision"))
      else Bench(Seq("Evader")).hovering(-5)
    val token = bench.call(name, params(name)*)
    while bench.answeredAt(token).isEmpty && bench.elapsedS < 70 do bench.pass(1)
    bench.answerOf(token)

  def params(name: String): Seq[Msg] =
    given Conversion[String, Msg]  = Str(_)
    given Conversion[Double, Msg]  = number => Float32(number.toFloat)
    given Conversion[Int, Msg]     = Int32(_)
    given Conversion[Boolean, Msg] = Bool(_)
    val v                          = ""
    val vector                     = writeMsg(Vector3r(1, 2, -3))
    val pose                       = writeMsg(Pose(Vector3r(1, 2, -3), Quaternionr(1, 0, 0, 0)))
    val point                      = writeMsg(GeoPoint(47.6415, -122.1402, 130))
    val yaw                        = writeMsg(YawMode.Still)
    val three                      = Arr(Float32(0.2f), Float32(0.2f), Float32(0.3f))
    val colour                     = Arr(Float32(1), Float32(0), Float32(0), Float32(1))
    val points                     = Arr(vector, vector)
    val words                      = Arr(Str("a"), Str("b"))
    val camera: Msg                = "front_center"
    name match
      case "enableApiControl" | "armDisarm" => Seq(true, v)
      case "simPause" | "simEnableWeather"  => Seq(true)
      case "simContinueForTime"             => Seq(0.1)
      case "simContinueForFrames"           => Seq(3)
      case "simSetWind"                     => Seq(vector)
      case "moveByRC"                       => Seq(writeMsg(RcData.Absent), v)
      case "takeoff" | "land" | "goHome"    => Seq(60, v)
      case "moveToPosition"                 => Seq(1.0, 1.0, -6.0, 2.0, 60, 0, yaw, -1, 1, v)
      case "moveToGPS"                      =>
        Seq(Float64(47.64147), Float64(-122.14017), 130.0, 2.0, 60, 0, yaw, -1, 1, v)
      case "moveOnPath"                           => Seq(points, 2.0, 60, 0, yaw, -1, 1, v)
      case "moveToZ"                              => Seq(-7.0, 2.0, 60, yaw, -1, 1, v)
      case "rotateToYaw"                          => Seq(30.0, 20, 5, v)
      case "rotateByYawRate"                      => Seq(30.0, 1, v)
      case "moveByManual"                         => Seq(2.0, 2.0, -5.0, 1, 0, yaw, v)
      case _ if name.startsWith("moveByVelocity") => Seq(1.0, 0.0, -5.0, 1, 0, yaw, v)
      case _ if name.startsWith("moveBy")         => Seq(0.0, 0.0, 0.0, 0.6, 1, v)
      case _ if name.endsWith("ControllerGains")  => Seq(three, three, three, v)
      case "getImuData" | "getGpsData" | "getBarometerData" | "getMagnetometerData" | "getLidarData" |
          "getDistanceSensorData" | "getEchoData" | "getGPULidarData" | "getUWBData" | "getUWBSensorData" |
          "getWifiData" | "getWifiSensorData" =>
        Seq("", v)
      case "simSetVehiclePose" => Seq(pose, true, v)
      case "setCarControls"    => Seq(writeMsg(CarControls(throttle = 1)), v)
      case "skeinHoverAt"      => Seq(pose, v)
      case "skeinFollowPlan"   => Seq(0, Arr(), v)
      case "simSetKinematics"  =>
        val zero = Vector3r.Zero
        Seq(writeMsg(KinematicsState(zero, Quaternionr(1, 0, 0, 0), zero, zero, zero, zero)), true, v)
      case "simSetPhysicsRawKinematics" =>
        val zero = Vector3r.Zero
        Seq(writeMsg(KinematicsState(zero, Quaternionr(1, 0, 0, 0), zero, zero, zero, zero)), v)
      case "setSafety"                        => Seq(1, 1.0, 0, 1.0, vector, 10.0, -20.0, 0.0, v)
      case "simListInstanceSegmentationPoses" => Seq(true, false)
      case "simListSceneObjectsTags"          => Seq(".*")
      case "simSetExtForce"                   => Seq(vector)
      case "simSetLidarPose" | "simSetDistanceSensorPose" | "simSetEchoPose" | "simSetGPULidarPose" =>
        Seq("One", pose, v)
      case "simSetWorldLightIntensity"              => Seq("Sun", 2.0)
      case "simSetWorldLightVisibility"             => Seq("Sun", true)
      case "simSetVehicleLightIntensity"            => Seq(v, "Lamp", 2.0)
      case "simSetVehicleLightVisibility"           => Seq(v, "Lamp", true)
      case "simListAnnotationPoses"                 => Seq("Layer", true, false)
      case "simSetAnnotationObjectID"               => Seq("Layer", "Evader", 3, false)
      case "simSetAnnotationObjectColor"            => Seq("Layer", "Evader", 1, 2, 3, false)
      case "simSetAnnotationObjectValue"            => Seq("Layer", "Evader", 0.5, false)
      case "simSetAnnotationObjectTextureByPath"    => Seq("Layer", "Evader", "wood", false)
      case "simEnableAnnotationObjectTextureByPath" => Seq("Layer", "Evader", false)
      case "simAddVehicle"                          => Seq("Another", "SimpleFlight", pose, "")
      case "simListSceneObjects"                    => Seq(".*")
      case "simGetObjectPose" | "simGetObjectScale" | "simDestroyObject" | "simGetSegmentationObjectID" =>
        Seq("Evader")
      case "simSetObjectPose"                      => Seq("Evader", pose, true)
      case "simSetObjectScale"                     => Seq("Evader", vector)
      case "simSpawnObject"                        => Seq("One", "Cube", pose, vector, false, false)
      case "simLoadLevel" | "simRunConsoleCommand" => Seq("stat fps")
      case "simTestLineOfSightToPoint"             => Seq(point, v)
      case "simTestLineOfSightBetweenPoints"       => Seq(point, point)
      case "simCreateVoxelGrid"                    => Seq(vector, 4, 4, 4, 1.0, "grid.binvox")
      case "simSetSegmentationObjectID"            => Seq("Evader", 7, false)
      case "simSetCameraPose"                      => Seq(camera, pose, v, false)
      case "simSetCameraFov"                       => Seq(camera, 60.0, v, false)
      case "simSetDistortionParam"                 => Seq(camera, "K1", 0.1, v, false)
      case "simGetImages"                          =>
        Seq(Arr(writeMsg(ImageRequest("0", 0, pixels_as_float = false, compress = true))), v, false)
      case "simGetImage" | "simGetDetections" | "simClearDetectionMeshNames" => Seq(camera, 0, v, false)
      case "simAddDetectionFilterMeshName" => Seq(camera, 0, "Car*", v, false)
      case "simSetDetectionFilterRadius"   => Seq(camera, 0, 2000.0, v, false)
      case "simSetPresetLensSettings"      => Seq("50mm Prime f/1.8", camera, v, false)
      case "simSetPresetFilmbackSettings"  => Seq("Full Frame DSLR", camera, v, false)
      case "simSetFilmbackSettings"        => Seq(36.0, 24.0, camera, v, false)
      case "simSetFocalLength" | "simSetFocusDistance" | "simSetFocusAperture" => Seq(20.0, camera, v, false)
      case "simEnableManualFocus" | "simEnableFocusPlane"                      => Seq(true, camera, v, false)
      case "simSetWeatherParameter"                                            => Seq(7, 0.5)
      case "simSetTimeOfDay" => Seq(true, "2018-02-12 15:20:00", false, 1, 60, true)
      case "simPlotPoints" | "simPlotLineStrip" | "simPlotLineList" => Seq(points, colour, 10.0, -1.0, false)
      case "simPlotArrows"              => Seq(points, points, colour, 5.0, 2.0, -1.0, false)
      case "simPlotStrings"             => Seq(words, points, 5.0, colour, 1.0)
      case "simPlotTransforms"          => Seq(Arr(pose, pose), 5.0, 5.0, -1.0, true)
      case "simPlotTransformsWithNames" =>
        Seq(Arr(pose, pose), words, 5.0, 5.0, 10.0, colour, -1.0)
      case "simSetTraceLine"                                          => Seq(colour, 5.0, v)
      case "simPrintLogMessage"                                       => Seq("a", "b", 0)
      case "simSetLightIntensity"                                     => Seq("Sun", 2.0)
      case "simSwapTextures"                                          => Seq("tag", 0, 0, 0)
      case "simSetObjectMaterial" | "simSetObjectMaterialFromTexture" => Seq("Evader", "wood", 0)
      case _                                                          =>
        val arity = Simulation.methods.find(_.name == name).get.arity
        if arity == 3 then Seq(camera, v, false) else Seq.fill(arity)(Str(""))
