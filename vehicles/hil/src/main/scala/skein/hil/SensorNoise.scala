package skein.hil

/** Sensor errors: white noise, and biases that drift. Defaults are AirSim's for inertial sensors,
  * magnetometer and barometer (`ImuSimpleParams`, an MPU-6000; `MagnetometerSimpleParams`;
  * `BarometerSimpleParams`, an MS5611) and PX4's for satellite positioning (its `sensor_gps_sim`): the values
  * against which autopilots' estimators are tested in simulation.
  *
  * @param gyroRadpsPerRootHz white noise of the gyroscope, rad/s/√Hz: 0.3°/√h
  * @param gyroBiasRadpsPerRootS random walk of its bias, rad/s/√s: 4.6°/h over the root of 500 s
  * @param accelMps2PerRootHz white noise of the accelerometer, m/s²/√Hz: 0.24 thousandths of gravity
  * @param accelBiasMps2PerRootS random walk of its bias, m/s²/√s: 36 millionths of gravity over the root of
  *   800 s
  * @param magneticGauss white noise of each reading of the magnetometer, gauss
  * @param pressurePa white noise of each reading of the barometer, Pa: 0.22 m
  * @param pressureDriftPa drift by the weather, Pa: a first-order Gauss-Markov process with a time constant
  *   of an hour. This value is Skein's own: it moves the altitude by 0.3 m in a minute
  * @param positionM error of each satellite fix, horizontally, m: a first-order process with 0.76 of the fix
  *   before; 1.5 times that vertically
  * @param velocityMps likewise, m/s, with 0.54 of the fix before; 1.2 times that vertically
  */
final case class SensorNoise(
    gyroRadpsPerRootHz: Double = math.toRadians(0.3) / 60,
    gyroBiasRadpsPerRootS: Double = math.toRadians(4.6) / 3600 / math.sqrt(500),
    accelMps2PerRootHz: Double = 0.24e-3 * 9.80665,
    accelBiasMps2PerRootS: Double = 36e-6 * 9.80665 / math.sqrt(800),
    magneticGauss: Double = 0.005,
    pressurePa: Double = 2.7,
    pressureDriftPa: Double = 20,
    positionM: Double = 0.8 * 0.02,
    velocityMps: Double = 0.05 * 0.4
)

object SensorNoise:
  /** Sensors without errors: every reading is the true value. */
  val None: SensorNoise = SensorNoise(0, 0, 0, 0, 0, 0, 0, 0, 0)
