package skein.units

/** Three components in one frame. The names of variables end with the frame: `positionNed` (north, east,
  * down) in metres, `velocityFrd` (front, right, down) in metres per second.
  */
final case class Vector3(x: Double, y: Double, z: Double):
  def +(other: Vector3): Vector3 = Vector3(x + other.x, y + other.y, z + other.z)
  def -(other: Vector3): Vector3 = Vector3(x - other.x, y - other.y, z - other.z)
  def *(factor: Double): Vector3 = Vector3(x * factor, y * factor, z * factor)
  def norm: Double               = math.sqrt(x * x + y * y + z * z)

  /** @param axis 0, 1 or 2 */
  private[skein] def component(axis: Int): Double = axis match
    case 0 => x
    case 1 => y
    case _ => z

  /** Distance in the horizontal plane, m, as in the paper's game. */
  def horizontalDistance(other: Vector3): Double = StrictMath.hypot(x - other.x, y - other.y)

object Vector3:
  val Zero: Vector3 = Vector3(0, 0, 0)

/** A rotation from body FRD to world NED as a unit quaternion. */
final case class Quaternion(w: Double, x: Double, y: Double, z: Double):
  /** Roll angle of the body, rad, positive to the right. */
  def rollRad: Double = StrictMath.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))

  /** Pitch angle of the body, rad, positive upwards. */
  def pitchRad: Double = StrictMath.asin((2 * (w * y - x * z)).max(-1.0).min(1.0))

  /** Yaw, rad from north towards east, −π to π. */
  def yawRad: Double = StrictMath.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

  def toWorld(frd: Vector3): Vector3 =
    val (tx, ty, tz) = (
      2 * (y * frd.z - z * frd.y),
      2 * (z * frd.x - x * frd.z),
      2 * (x * frd.y - y * frd.x)
    )
    Vector3(
      frd.x + w * tx + y * tz - z * ty,
      frd.y + w * ty + z * tx - x * tz,
      frd.z + w * tz + x * ty - y * tx
    )

  def toBody(ned: Vector3): Vector3 = inverse.toWorld(ned)

  /** The rotation back: from world NED to body FRD. */
  def inverse: Quaternion = Quaternion(w, -x, -y, -z)

  /** The rotation that consists of `inner`, followed by this one. */
  def *(inner: Quaternion): Quaternion = Quaternion(
    w * inner.w - x * inner.x - y * inner.y - z * inner.z,
    w * inner.x + x * inner.w + y * inner.z - z * inner.y,
    w * inner.y - x * inner.z + y * inner.w + z * inner.x,
    w * inner.z + x * inner.y - y * inner.x + z * inner.w
  )

  /** This quaternion scaled to length 1; no rotation if its length is 0. */
  def normalized: Quaternion =
    val length = math.sqrt(w * w + x * x + y * y + z * z)
    if length == 0 then Quaternion.Identity else Quaternion(w / length, x / length, y / length, z / length)

object Quaternion:
  val Identity: Quaternion = Quaternion(1, 0, 0, 0)

  /** The orientation after a yaw, then a pitch about the turned axis, then a roll, rad. */
  def of(rollRad: Double, pitchRad: Double, yawRad: Double): Quaternion =
    val (cr, sr) = (StrictMath.cos(rollRad / 2), StrictMath.sin(rollRad / 2))
    val (cp, sp) = (StrictMath.cos(pitchRad / 2), StrictMath.sin(pitchRad / 2))
    val (cy, sy) = (StrictMath.cos(yawRad / 2), StrictMath.sin(yawRad / 2))
    Quaternion(
      cr * cp * cy + sr * sp * sy,
      sr * cp * cy - cr * sp * sy,
      cr * sp * cy + sr * cp * sy,
      cr * cp * sy - sr * sp * cy
    )

  /** The level orientation with this heading, rad from north towards east. */
  def ofYaw(headingRad: Double): Quaternion =
    Quaternion(StrictMath.cos(headingRad / 2), 0, 0, StrictMath.sin(headingRad / 2))
