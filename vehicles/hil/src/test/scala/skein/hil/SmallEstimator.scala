package skein.hil

import scala.collection.mutable
import skein.units.*

/** A small autopilot's estimator for noisy sensors: a complementary filter of attitude (Mahony, Hamel,
  * Pflimlin, IEEE Transactions on Automatic Control 53, 2008) and one of position and velocity, which use
  * inertial sensors for fast changes and the others for slow ones.
  */
final class SmallEstimator:
  import SmallEstimator.*

  private var attitude = Quaternion.Identity
  private var bias     = Vector3.Zero
  private var aligned  = 0
  private var first    = Option.empty[GeoLocation]
  private var ground   = Option.empty[Double]
  private var fixes    = 0
  private val before   = mutable.Queue.empty[(Vector3, Vector3)]

  var positionNed: Vector3        = Vector3.Zero
  var velocityNed: Vector3        = Vector3.Zero
  var angularVelocityFrd: Vector3 = Vector3.Zero

  def orientation: Quaternion = attitude

  /** Whether it has stood still long enough to know its attitude and position. */
  def isReady: Boolean = aligned >= Alignment && fixes >= 8

  def inertial(specificForceFrd: Vector3, gyroFrd: Vector3, dtS: Double): Unit =
    angularVelocityFrd = gyroFrd - bias
    val isStanding = aligned < Alignment
    val up         = attitude.toBody(Vector3(0, 0, -1))
    val tilt       = cross(specificForceFrd * (1 / specificForceFrd.norm.max(1e-9)), up)
    val gain       = if isStanding then 2.0 else 0.15
    if math.abs(specificForceFrd.norm - G) < 2 then
      bias = bias - tilt * (gain * 0.05 * dtS)
      turn((angularVelocityFrd + tilt * gain) * dtS)
    else turn(angularVelocityFrd * dtS)
    if isStanding then aligned += 1
    else
      val acceleration = attitude.toWorld(specificForceFrd) + Vector3(0, 0, G)
      velocityNed = velocityNed + acceleration * dtS
      positionNed = positionNed + velocityNed * dtS
    before.enqueue((positionNed, velocityNed))
    if before.size > FixTicks then before.dequeue(): Unit

  def magnetic(fieldFrd: Vector3): Unit = for place <- first do
    val seen      = attitude.toWorld(fieldFrd)
    val published = MagneticField.ned(place)
    val off       = StrictMath.atan2(seen.y, seen.x) - StrictMath.atan2(published.y, published.x)
    val gain      = if aligned < Alignment then 0.1 else 0.01
    turn(attitude.toBody(Vector3(0, 0, -math.IEEEremainder(off, 2 * math.Pi) * gain)))

  def altitude(aboveSeaM: Double): Unit =
    val zero = ground.getOrElse(aboveSeaM)
    // While it stands still, it learns the ground's altitude.
    ground = Some(if aligned < Alignment then zero + (aboveSeaM - zero) * 0.05 else zero)
    val off = zero - aboveSeaM - positionNed.z
    positionNed = positionNed + Vector3(0, 0, off * 0.02)
    velocityNed = velocityNed + Vector3(0, 0, off * 0.02)

  /** Uses a delayed satellite fix. */
  def fix(place: GeoLocation, velocity: Vector3): Unit =
    val zero = first.getOrElse(place)
    first = Some(zero)
    fixes += 1
    for (position, speed) <- before.headOption do
      val off    = place.nedFrom(zero) - position
      val speeds = velocity - speed
      positionNed = positionNed + Vector3(off.x, off.y, 0) * 0.3
      velocityNed = velocityNed + Vector3(speeds.x, speeds.y, speeds.z * 0.5) * 0.3

  private def turn(byFrd: Vector3): Unit =
    val q = Quaternion(1, byFrd.x / 2, byFrd.y / 2, byFrd.z / 2)
    val a = attitude
    val n = Quaternion(
      a.w * q.w - a.x * q.x - a.y * q.y - a.z * q.z,
      a.w * q.x + a.x * q.w + a.y * q.z - a.z * q.y,
      a.w * q.y - a.x * q.z + a.y * q.w + a.z * q.x,
      a.w * q.z + a.x * q.y - a.y * q.x + a.z * q.w
    )
    val norm = math.sqrt(n.w * n.w + n.x * n.x + n.y * n.y + n.z * n.z)
    attitude = Quaternion(n.w / norm, n.x / norm, n.y / norm, n.z / norm)

object SmallEstimator:
  private val G = 9.80665

  /** Number of inertial readings at rest for alignment. */
  private val Alignment = 500

  /** Age of a fix in inertial readings. */
  private val FixTicks = 28

  private def cross(a: Vector3, b: Vector3) =
    Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
