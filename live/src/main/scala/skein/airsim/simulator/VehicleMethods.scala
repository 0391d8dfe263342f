package skein.airsim.simulator

import skein.airsim.GeoLocation
import skein.airsim.wire.*
import skein.units.*

/** Functions that read or set the state of one vehicle. Sensors report the truth, without noise or delay. */
private[simulator] object VehicleMethods:
  import Method.*

  val all: Seq[Method] = Seq(
    many[(Boolean, Text)]("enableApiControl"):
      case (simulation, (on, name)) =>
        vehicle(simulation, name): (_, vehicle) =>
          vehicle.setApiControl(on)
          Nil
    ,
    one[Text]("isApiControlEnabled")((simulation, name) =>
      vehicle(simulation, name)((_, vehicle) => answer(vehicle.apiControl))
    ),
    many[(Boolean, Text)]("armDisarm"):
      case (simulation, (on, name)) => vehicle(simulation, name)((_, vehicle) => answer(vehicle.arm(on)))
    ,
    many[(RcData, Text)]("moveByRC"):
      case (simulation, (sticks, name)) =>
        vehicle(simulation, name): (_, vehicle) =>
          vehicle.steer(sticks)
          Nil
    ,
    one[Text]("cancelLastTask"): (simulation, name) =>
      vehicle(simulation, name): (index, _) =>
        simulation.world.cancelMove(index)
        Nil
    ,
    one[Text]("getMultirotorState")((simulation, name) =>
      vehicle(simulation, name)((_, vehicle) => answer(state(vehicle, simulation.world.now)))
    ),
    one[Text]("getRotorStates")((simulation, name) =>
      vehicle(simulation, name)((_, vehicle) => answer(rotors(vehicle, simulation.world.now)))
    ),
    one[Text]("getHomeGeoPoint")((simulation, name) =>
      vehicle(simulation, name)((_, vehicle) => answer(geoPoint(vehicle.home)))
    ),
    one[Text]("simGetGroundTruthKinematics")((simulation, name) =>
      simulated(simulation, name)((_, vehicle) => answer(kinematics(vehicle, simulation.world.now)))
    ),
    one[Text]("simGetGroundTruthEnvironment")((simulation, name) =>
      simulated(simulation, name)((_, vehicle) => answer(environment(vehicle, simulation.world.now)))
    ),
    one[Text]("simGetVehiclePose")((simulation, name) =>
      simulated(simulation, name)((_, vehicle) => answer(pose(vehicle, simulation.world.now)))
    ),
    many[(Pose, Boolean, Text)]("simSetVehiclePose"):
      case (simulation, (pose, _, name)) =>
        simulated(simulation, name): (_, vehicle) =>
          vehicle.place(pose.position.toVector, pose.orientation.toQuaternion, simulation.world.now)
          Nil
    ,
    one[Text]("simGetCollisionInfo")((simulation, name) =>
      simulated(simulation, name)((_, vehicle) => answer(collision(vehicle.takeTouch())))
    ),
    sensor("getImuData")((vehicle, at) => answer(imu(vehicle, at))),
    sensor("getGpsData")((vehicle, at) => answer(gps(vehicle, at))),
    sensor("getBarometerData")((vehicle, at) => answer(barometer(vehicle, at))),
    sensor("getMagnetometerData")((vehicle, at) => answer(magnetometer(vehicle, at))),
    sensorless("getLidarData", "lidar"),
    sensorless("getDistanceSensorData", "distance sensor")
  )

  /** Every vehicle has one of each kind of sensor, whatever name is asked for. */
  private def sensor(method: String)(read: (SimulatedVehicle, Instant) => Outcome): Method =
    many[(Text, Text)](method):
      case (simulation, (_, name)) =>
        vehicle(simulation, name)((_, vehicle) => read(vehicle, simulation.world.now))

  private def sensorless(method: String, kind: String): Method =
    many[(Text, Text)](method):
      case (simulation, (sensor, name)) =>
        vehicle(simulation, name)((_, _) =>
          Outcome.Threw(s"No $kind with name ${sensor.value} exist on vehicle")
        )

  private def state(vehicle: SimulatedVehicle, at: Instant) = MultirotorState(
    CollisionInfo.None,
    kinematics(vehicle, at),
    geoPoint(vehicle.locationAt(at)),
    at,
    if vehicle.flying then 1 else 0,
    vehicle.sticks
  )

  private def kinematics(vehicle: SimulatedVehicle, at: Instant) = KinematicsState(
    Vector3r(vehicle.positionAt(at)),
    Quaternionr(vehicle.state.orientation),
    Vector3r(vehicle.velocityAt(at)),
    Vector3r(vehicle.state.angularVelocityFrd),
    Vector3r(vehicle.state.accelerationNed),
    Vector3r(vehicle.state.angularAccelerationFrd)
  )

  private def pose(vehicle: SimulatedVehicle, at: Instant) =
    Pose(Vector3r(vehicle.positionAt(at)), Quaternionr(vehicle.state.orientation))

  private def collision(touch: Option[Touch]) = touch.fold(CollisionInfo.None): touch =>
    val place = Vector3r(touch.positionNed)
    CollisionInfo(true, 0, touch.at, Vector3r(0, 0, -1), place, place, "Ground", -1)

  private def imu(vehicle: SimulatedVehicle, at: Instant) =
    // The ground carries a vehicle that stands, and physics does not move it.
    val acceleration = if vehicle.state.grounded then Vector3.Zero else vehicle.state.accelerationNed
    val force        = acceleration - Vector3(0, 0, Gravity)
    ImuData(
      at,
      Quaternionr(vehicle.state.orientation),
      Vector3r(vehicle.state.angularVelocityFrd),
      Vector3r(Frames.intoBody(force, vehicle.state.orientation))
    )

  private def gps(vehicle: SimulatedVehicle, at: Instant) =
    val micros = Instant.ofNanos(at.toNanos / 1000)
    val report =
      GnssReport(
        geoPoint(vehicle.locationAt(at)),
        0.1f,
        0.1f,
        Vector3r(vehicle.velocityAt(at)),
        ThreeDFix,
        micros
      )
    GpsData(at, report, is_valid = true)

  private def barometer(vehicle: SimulatedVehicle, at: Instant) =
    val pressure = Globe.pressurePa(vehicle.locationAt(at).altitude.value)
    BarometerData(
      at,
      Globe.pressureAltitudeM(pressure).toFloat,
      pressure.toFloat,
      (Globe.SeaLevelPressure / 100).toFloat
    )

  private def magnetometer(vehicle: SimulatedVehicle, at: Instant) =
    val field = Frames.intoBody(Globe.magneticFieldNed(vehicle.locationAt(at)), vehicle.state.orientation)
    MagnetometerData(at, Vector3r(field), Seq.empty)

  private def environment(vehicle: SimulatedVehicle, at: Instant) =
    val place    = vehicle.locationAt(at)
    val altitude = place.altitude.value
    EnvironmentState(
      Vector3r(vehicle.positionAt(at)),
      geoPoint(place),
      Vector3r(0, 0, Gravity.toFloat),
      Globe.pressurePa(altitude).toFloat,
      Globe.temperatureK(altitude).toFloat,
      Globe.airDensity(altitude).toFloat
    )

  private def rotors(vehicle: SimulatedVehicle, at: Instant) =
    val density = vehicle.densityRatio
    val thrusts =
      Seq(vehicle.state.thrust0, vehicle.state.thrust1, vehicle.state.thrust2, vehicle.state.thrust3)
    val rotors =
      for (thrust, turn) <- thrusts.zip(Seq(1, 1, -1, -1))
      yield RotorState(
        (thrust * vehicle.airframe.maxThrustN * density).toFloat,
        (thrust * vehicle.airframe.maxTorqueNm * density * turn).toFloat,
        (math.sqrt(thrust) * MaxRotorSpeed * turn).toFloat
      )
    RotorStates(at, rotors)

  private def geoPoint(place: GeoLocation) =
    GeoPoint(place.latitudeDeg, place.longitudeDeg, place.altitude.value.toFloat)

  private val Gravity   = skein.vehicle.Airframe.Gravity
  private val ThreeDFix = 3

  /** AirSim's rotors reach 6396.667 turns a minute; rad/s. */
  private val MaxRotorSpeed = 6396.667 * 2 * math.Pi / 60
