package skein.simulator

import skein.airsim.SensorKind
import skein.airsim.wire.*
import skein.scene.Rays
import skein.units.*
import upickle.default.Writer

/** Functions that read or set the state of one vehicle. The state and GPS are what [[SimulatedSensing]] makes
  * of the truth; other sensors report true values. None has a delay; AirSim's GPS reports 0.2 s late.
  */
private[simulator] object VehicleMethods extends MethodList:
  import ServerMethod.*

  many[(Boolean, String)]("enableApiControl"):
    case (simulation, (on, name)) =>
      vehicle(simulation, name)((_, vehicle) => done(vehicle.setApiControl(on)))
  read("isApiControlEnabled", vehicle)((vehicle, _) => vehicle.apiControl)
  many[(Boolean, String)]("armDisarm"):
    case (simulation, (on, name)) => vehicle(simulation, name)((_, vehicle) => answer(vehicle.arm(on)))
  // AirSim's vehicles have no safety evaluation either, and answer so.
  many[(Argument.Unsigned32, Float, Int, Float, Vector3r, Float, Float, Float, String)]("setSafety"):
    case (simulation, (_, _, _, _, _, _, _, _, name)) =>
      multirotor(simulation, name)((_, _) =>
        CallOutcome.Threw("The setSafety call requires safety_eval_ptr_ to be set first")
      )
  many[(RcData, String)]("moveByRC"):
    case (simulation, (sticks, name)) =>
      multirotor(simulation, name)((_, vehicle) => done(vehicle.steer(sticks)))
  one[String]("cancelLastTask")((simulation, name) =>
    vehicle(simulation, name)((index, _) => done(simulation.world.cancelMove(index)))
  )
  one[String]("getMultirotorState")((simulation, name) =>
    multirotor(simulation, name)((_, vehicle) => answer(state(vehicle, sensed(simulation, vehicle))))
  )
  read("getRotorStates", multirotor)(rotors)
  read("getHomeGeoPoint", vehicle)((vehicle, _) => GeoPoint(vehicle.home))
  read("simGetGroundTruthKinematics", simulated)(kinematics)
  read("simGetGroundTruthEnvironment", simulated)(environment)
  read("simGetVehiclePose", simulated)(pose)
  many[(Pose, Boolean, String)]("simSetVehiclePose"):
    case (simulation, (pose, _, name)) =>
      simulated(simulation, name): (_, vehicle) =>
        within(pose.position):
          done(vehicle.place(pose.position.toVector, pose.orientation.toQuaternion, simulation.world.now))
  read("simGetCollisionInfo", simulated)((vehicle, _) => vehicle.takeTouch().getOrElse(CollisionInfo.None))
  many[(Pose, String)]("skeinHoverAt"):
    case (simulation, (pose, name)) =>
      multirotor(simulation, name): (index, vehicle) =>
        val place = pose.position.toVector
        if !vehicle.apiControl then CallOutcome.Threw("only a vehicle under api control can hover")
        else if !vehicle.isAboveGround(place) then
          CallOutcome.Threw(s"expected a place above the ground, got z = ${place.z} m")
        else
          simulation.world.forgetPlans(index)
          val turn = pose.orientation.toQuaternion
          within(pose.position):
            done(vehicle.hoverAt(place, 2 * StrictMath.atan2(turn.z, turn.w), simulation.world.now))
  sensor("getImuData", SensorKind.Imu, "IMU")(imu)
  sensor("getGpsData", SensorKind.Gps, "gps")(Gps.read)
  sensor("getBarometerData", SensorKind.Barometer, "barometer")(barometer)
  sensor("getMagnetometerData", SensorKind.Magnetometer, "magnetometer")(magnetometer)
  many[(String, String)]("getLidarData"):
    case (simulation, (sensor, name)) =>
      vehicle(simulation, name): (index, vehicle) =>
        val scan =
          for
            (own, lidar) <- simulation.equipment.lidar(vehicle.settings, sensor)
            scan         <- simulation.world.scanOf(index, own, lidar)
          yield scan
        scan.fold(missing("lidar", sensor)): scan =>
          val ids = simulation.objects.ids
          CallOutcome.Draws(() => LidarData.encode(scan.data(ids(_))))
  many[(String, String)]("getDistanceSensorData"):
    case (simulation, (sensor, name)) =>
      vehicle(simulation, name): (index, vehicle) =>
        simulation.equipment.ranger(vehicle.settings, sensor).fold(missing("distance sensor", sensor)):
          ranger => answer(distance(simulation, index, ranger))

  /** A function that reads a sensor by name; an empty name means the first of its kind. */
  private def sensor[A: Writer](method: String, kind: SensorKind, called: String)(
      value: (SimulatedVehicle, Instant) => A
  ): Unit =
    many[(String, String)](method):
      case (simulation, (sensor, name)) =>
        vehicle(simulation, name): (_, vehicle) =>
          if vehicle.settings.sensors.exists((has, is) => is == kind && (sensor.isEmpty || sensor == has))
          then answer(value(vehicle, simulation.world.now))
          else missing(called, sensor)

  /** Distance along the sensor's front, at most its range. */
  private def distance(simulation: Simulated, index: Int, ranger: SensorSettings.Ranger): DistanceSensorData =
    val at     = simulation.world.now
    val sensor = simulation.world.placeOf(index, at).outside(ranger.place)
    val moment = simulation.objects.moment
    val rays   = Rays(moment, sensor.position, ranger.mostM, moment.itemOf(index))
    val met    = rays.cast(sensor.front.x, sensor.front.y, sensor.front.z)
    DistanceSensorData(
      at,
      math.min(met, ranger.mostM).toFloat,
      ranger.leastM.toFloat,
      ranger.mostM.toFloat,
      Pose(ranger.place.position, ranger.place.orientation)
    )

  def missing(kind: String, sensor: String): CallOutcome =
    CallOutcome.Threw(s"No $kind with name $sensor exist on vehicle")

  private def state(vehicle: SimulatedMultirotor, seen: Sensed) = MultirotorState(
    CollisionInfo.None,
    kinematics(seen),
    GeoPoint(vehicle.home.locate(seen.motion.positionNed)),
    seen.at,
    if vehicle.flying then 1 else 0,
    vehicle.sticks,
    seen.isMissing
  )

  /** What the vehicle's sensors report; there is always a reading while the simulator is paused. */
  def sensed(simulation: Simulated, vehicle: SimulatedVehicle): Sensed =
    vehicle.sensed(simulation.world.now, mayMiss = !simulation.isPaused)

  def kinematics(vehicle: SimulatedVehicle, at: Instant): KinematicsState = kinematics(vehicle.truth(at))

  def kinematics(seen: Sensed): KinematicsState = KinematicsState(
    Vector3r(seen.motion.positionNed),
    Quaternionr(seen.motion.orientation),
    Vector3r(seen.motion.velocityNed),
    Vector3r(seen.motion.angularVelocityFrd),
    Vector3r(seen.accelerationNed),
    Vector3r(seen.angularAccelerationFrd)
  )

  private def pose(vehicle: SimulatedVehicle, at: Instant) =
    Pose(vehicle.positionAt(at), vehicle.orientation)

  private def imu(vehicle: SimulatedVehicle, at: Instant) =
    // Physics does not move a vehicle that stands on the ground.
    val acceleration = if vehicle.isGrounded then Vector3.Zero else vehicle.accelerationNed
    val force        = acceleration - Vector3(0, 0, Gravity)
    ImuData(
      at,
      Quaternionr(vehicle.orientation),
      Vector3r(vehicle.angularVelocityFrd),
      Vector3r(vehicle.orientation.toBody(force))
    )

  private def barometer(vehicle: SimulatedVehicle, at: Instant) =
    val pressure = Globe.pressurePa(vehicle.locationAt(at).altitude.value)
    BarometerData(
      at,
      Globe.pressureAltitudeM(pressure).toFloat,
      pressure.toFloat,
      (Globe.SeaLevelPressure / 100).toFloat
    )

  private def magnetometer(vehicle: SimulatedVehicle, at: Instant) =
    val field =
      vehicle.orientation.toBody(Globe.magneticFieldNed(vehicle.locationAt(at)))
    MagnetometerData(at, Vector3r(field), Seq.empty)

  private def environment(vehicle: SimulatedVehicle, at: Instant) =
    val place    = vehicle.locationAt(at)
    val altitude = place.altitude.value
    EnvironmentState(
      Vector3r(vehicle.positionAt(at)),
      GeoPoint(place),
      Vector3r(0, 0, Gravity.toFloat),
      Globe.pressurePa(altitude).toFloat,
      Globe.temperatureK(altitude).toFloat,
      Globe.airDensity(altitude).toFloat
    )

  /** Thrust and torque as at sea level: AirSim reports them before it scales them by the air's density. The
    * torque acts on the body; AirSim counts it upwards: negative for the two rotors that turn
    * counter-clockwise.
    */
  private def rotors(vehicle: SimulatedMultirotor, at: Instant) =
    val thrusts =
      Seq(vehicle.state.thrust0, vehicle.state.thrust1, vehicle.state.thrust2, vehicle.state.thrust3)
    val rotors =
      for (thrust, turn) <- thrusts.zip(Seq(-1, -1, 1, 1))
      yield RotorState(
        (thrust * vehicle.airframe.maxThrustN).toFloat,
        (thrust * vehicle.airframe.maxTorqueNm * turn).toFloat,
        (math.sqrt(thrust) * MaxRotorSpeed).toFloat
      )
    RotorStates(rotors, at)

  private val Gravity = skein.vehicle.Airframe.Gravity

  /** Maximum rotor speed of AirSim, 6396.667 turns a minute, in rad/s. */
  private val MaxRotorSpeed = 6396.667 * 2 * math.Pi / 60
