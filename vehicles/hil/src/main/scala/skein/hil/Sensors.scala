package skein.hil

import skein.signal.{NormalQuantile, SplitMix64}
import skein.units.*

/** The sensors of one vehicle, with their errors. Readings depend on the seed and on earlier readings; equal
  * seeds and equal input give equal readings. Not thread-safe.
  */
final class Sensors(seed: Long, noise: SensorNoise = SensorNoise()):
  import Sensors.*

  private val random       = SplitMix64(seed)
  private var gyroBias     = Vector3.Zero
  private var accelBias    = Vector3.Zero
  private var drift        = normal(noise.pressureDriftPa)
  private var positionOff  = Vector3.Zero
  private var velocityOff  = Vector3.Zero
  private var pressureRead = Option.empty[Instant]

  /** Gyroscope and accelerometer readings, averaged over `periodS`, s. */
  def inertial(truth: SensorTruth, periodS: Double): Inertial =
    val root = math.sqrt(periodS)
    gyroBias = gyroBias + normal3(noise.gyroBiasRadpsPerRootS * root)
    accelBias = accelBias + normal3(noise.accelBiasMps2PerRootS * root)
    Inertial(
      truth.specificForceFrd + accelBias + normal3(noise.accelMps2PerRootHz / root),
      truth.kinematics.angularVelocityFrd + gyroBias + normal3(noise.gyroRadpsPerRootHz / root)
    )

  /** A magnetometer reading of the field, FRD, gauss. */
  def magneticFrd(truth: SensorTruth): Vector3 =
    truth.kinematics.orientation.toBody(MagneticField.ned(truth.place)) + normal3(noise.magneticGauss)

  /** A barometer reading of the air pressure, Pa. */
  def pressurePa(truth: SensorTruth): Double =
    val keep = StrictMath.exp(-pressureRead.fold(Span.Zero)(before =>
      truth.at.since(before)
    ).toSeconds / DriftTimeConstantS)
    drift = drift * keep + normal(noise.pressureDriftPa * math.sqrt(1 - keep * keep))
    pressureRead = Some(truth.at)
    truth.pressurePa + drift + normal(noise.pressurePa)

  /** A satellite fix of the current position and velocity. */
  def fix(truth: SensorTruth): Fix =
    positionOff = positionOff * PositionKept + scaled(normal3(noise.positionM), 1.5)
    velocityOff = velocityOff * VelocityKept + scaled(normal3(noise.velocityMps), 1.2)
    Fix(truth.at, truth.place.locate(positionOff), truth.kinematics.velocityNed + velocityOff)

  private def scaled(v: Vector3, vertically: Double) = Vector3(v.x, v.y, v.z * vertically)

  private def normal3(deviation: Double) =
    // Evaluated in this order, independent of the compiler's order of arguments.
    val x = normal(deviation)
    val y = normal(deviation)
    Vector3(x, y, normal(deviation))

  private def normal(deviation: Double): Double =
    // 0 has no quantile.
    deviation * NormalQuantile(random.nextDouble().max(1e-17))

object Sensors:
  /** Readings of accelerometer and gyroscope: m/s² and rad/s, FRD. */
  final case class Inertial(specificForceFrd: Vector3, angularVelocityFrd: Vector3)

  /** A satellite fix.
    *
    * @param velocityNed m/s
    */
  final case class Fix(at: Instant, place: GeoLocation, velocityNed: Vector3)

  private val DriftTimeConstantS = 3600.0
  private val PositionKept       = 0.76
  private val VelocityKept       = 0.54
