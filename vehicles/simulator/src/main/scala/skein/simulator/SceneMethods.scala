package skein.simulator

import skein.airsim.{VehicleSettings, WorldSettings}
import skein.airsim.wire.*
import skein.scene.Placement
import skein.units.*

/** Functions of the scene's content: the ground, objects and vehicles. There are no assets, levels or meshes.
  */
private[simulator] object SceneMethods extends MethodList:
  import ServerMethod.*
  import VehicleLimits.{FarthestM, LongestName, MostVehicles}

  many[(String, String, Pose, String)]("simAddVehicle"):
    case (simulation, (name, kind, pose, _)) => addVehicle(simulation, name, kind, pose)
  many[(KinematicsState, Boolean, String)]("simSetKinematics"):
    case (simulation, (state, _, name)) => setKinematics(simulation, state, name)
  one[String]("simListSceneObjects"): (simulation, regex) =>
    val pattern = NamePattern(regex)
    answer(simulation.objects.names.filter(pattern.matches))
  one[String]("simGetObjectPose")((simulation, name) => answer(simulation.objects.poseOf(name)))
  many[(String, Option[Pose], Boolean)]("simSetObjectPose"):
    case (simulation, (name, pose, _)) =>
      // A missing object is reported for any pose: `simGetObjectPose` returns NaN for it.
      if simulation.objects.vehicle(name).isEmpty && simulation.objects.thing(name).isEmpty then
        answer(false)
      else pose.fold(throw NotFinite())(there => within(there.position)(moveTo(simulation, name, there)))
  one[String]("simGetObjectScale")((simulation, name) =>
    answer(Vector3r(simulation.objects.scale(name).getOrElse(Vector3.Zero)))
  )
  many[(String, Vector3r)]("simSetObjectScale"):
    case (simulation, (name, scale)) => answer(simulation.objects.setScale(name, scale.toVector))
  many[(String, String, Pose, Vector3r, Boolean, Boolean)]("simSpawnObject"):
    case (_, (_, asset, _, _, _, _)) =>
      CallOutcome.Threw(s"There were no objects with name $asset found in the Registry")
  one[String]("simDestroyObject")((_, _) => answer(false))
  none("simListAssets")(_ => answer(Seq.empty[String]))
  one[String]("simLoadLevel")((_, _) => answer(false))
  none("simGetMeshPositionVertexBuffers")(_ => answer(Seq.empty[Int]))
  many[(String, Int, Boolean)]("simSetSegmentationObjectID"):
    case (simulation, (name, id, isRegex)) =>
      val which: String => Boolean =
        if isRegex then NamePattern(name, ignoreCase = true).matches else _ == name
      answer(simulation.objects.setId(which, id))
  one[String]("simGetSegmentationObjectID")((simulation, name) =>
    answer(simulation.objects.id(name).getOrElse(-1))
  )
  many[(GeoPoint, String)]("simTestLineOfSightToPoint"):
    case (simulation, (point, name)) =>
      simulated(simulation, name): (index, vehicle) =>
        val from  = vehicle.worldPosition(simulation.world.now)
        val boxes = simulation.objects.boxes
        answer(boxes.sees(from, place(simulation, point), except = boxes.itemOf(index)))
  many[(GeoPoint, GeoPoint)]("simTestLineOfSightBetweenPoints"):
    case (simulation, (from, to)) =>
      answer(simulation.objects.boxes.sees(place(simulation, from), place(simulation, to)))
  none("simGetWorldExtents"): simulation =>
    def corner(sign: Int, down: Double) =
      GeoPoint(simulation.settings.world.origin.locate(Vector3(sign * ExtentM, sign * ExtentM, down)))
    answer(Seq(corner(-1, 0), corner(1, -ExtentM)))
  // Clients have no files written.
  many[(Vector3r, Int, Int, Int, Float, String)]("simCreateVoxelGrid")((_, _) => answer(false))

  /** The world's extent as reported to clients, from the origin and upwards, m; the world has no edge. */
  private val ExtentM = 10_000.0

  private def addVehicle(simulation: Simulated, name: String, kind: String, pose: Pose): CallOutcome =
    val start = pose.position.toVector
    if name.isEmpty || name.length > LongestName then
      CallOutcome.Threw(s"a vehicle's name has 1 to $LongestName characters, not ${name.length}")
    else if simulation.world.vehicles.size >= MostVehicles then
      CallOutcome.Threw(s"the built-in simulator flies at most $MostVehicles vehicles")
    else if start.norm > FarthestM then CallOutcome.Threw(s"a start within ${FarthestM / 1000} km is wanted")
    else
      val sensors = simulation.settings.world.defaultSensors.over(WorldSettings.usualSensors(kind))
      val added   = VehicleSettings(name, start, vehicleType = kind, sensors = sensors)
      val known   = VehicleLimits.flies(added) && !simulation.objects.exists(name)
      if known then
        val yaw = pose.orientation.toQuaternion.normalized.yawRad
        simulation.addVehicle(added.copy(yaw = Radians(yaw)))
      answer(known)

  def setKinematics(simulation: Simulated, state: KinematicsState, name: String): CallOutcome =
    simulated(simulation, name): (_, vehicle) =>
      if !isFlyable(state) then
        CallOutcome.Threw(
          "kinematics within 1000 km, 10 km/s, 1000 rad/s, 1000 km/s² and 1000000 rad/s² are wanted"
        )
      else done(vehicle.setKinematics(state, simulation.world.now))

  private def moveTo(simulation: Simulated, name: String, pose: Pose): CallOutcome =
    for vehicle <- simulation.objects.vehicle(name) do
      val position = pose.position.toVector - vehicle.settings.startNed
      vehicle.place(position, pose.orientation.toQuaternion, simulation.world.now)
    for index <- simulation.objects.thing(name) do
      simulation.world.scene = simulation.world.scene.moved(
        index,
        Placement(pose.position.toVector, pose.orientation.toQuaternion.normalized)
      )
    answer(true)

  private def isFlyable(state: KinematicsState): Boolean =
    state.position.toVector.norm <= FarthestM &&
      state.linear_velocity.toVector.norm <= 1e4 &&
      state.angular_velocity.toVector.norm <= 1e3 &&
      state.linear_acceleration.toVector.norm <= 1e6 &&
      state.angular_acceleration.toVector.norm <= 1e6

  private def place(simulation: Simulated, point: GeoPoint): Vector3 =
    point.toLocation.nedFrom(simulation.settings.world.origin)
