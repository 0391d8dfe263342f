package skein.units

/** Three components in one frame; the name of the variable ends with the frame: `positionNed` (north, east, down) in
  * metres, `velocityFrd` (front, right, down) in metres per second.
  */
final case class Vector3(x: Double, y: Double, z: Double):
  def +(other: Vector3): Vector3 = Vector3(x + other.x, y + other.y, z + other.z)
  def -(other: Vector3): Vector3 = Vector3(x - other.x, y - other.y, z - other.z)
  def *(factor: Double): Vector3 = Vector3(x * factor, y * factor, z * factor)
  def norm: Double               = math.sqrt(x * x + y * y + z * z)

  /** Distance in the horizontal plane, m: the distance of the paper's game. */
  def horizontalDistance(other: Vector3): Double = StrictMath.hypot(x - other.x, y - other.y)

object Vector3:
  val Zero: Vector3 = Vector3(0, 0, 0)

/** A rotation from body FRD to world NED as a unit quaternion. */
final case class Quaternion(w: Double, x: Double, y: Double, z: Double)

object Quaternion:
  val Identity: Quaternion = Quaternion(1, 0, 0, 0)
