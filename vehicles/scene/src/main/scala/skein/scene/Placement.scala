package skein.scene

import skein.units.{Quaternion, Vector3}

/** A position and orientation: transforms from its own frame (front, right, down) to the frame it is placed
  * in, such as the world (north, east, down). Metres.
  *
  * @param orientation a unit quaternion
  */
final class Placement(val position: Vector3, val orientation: Quaternion = Quaternion.Identity):
  import orientation.{w, x, y, z}

  /** Its own axes, in the frame it is placed in. */
  val front: Vector3 = Vector3(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
  val right: Vector3 = Vector3(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))
  val down: Vector3  = Vector3(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))

  /** Transforms a position from this frame to the outer one. */
  def outside(own: Vector3): Vector3 = position + turned(own)

  /** Rotates a direction from this frame to the outer one. */
  def turned(own: Vector3): Vector3 = front * own.x + right * own.y + down * own.z

  /** Transforms a position from the outer frame to this one. */
  def inside(there: Vector3): Vector3 =
    val from = there - position
    Vector3(from.dot(front), from.dot(right), from.dot(down))

  /** Transforms a placement in this frame to the outer frame. */
  def outside(inner: Placement): Placement =
    Placement(outside(inner.position), orientation * inner.orientation)

object Placement:
  /** A placement turned by roll, then pitch, then yaw, degrees: the order of AirSim's settings. */
  def turned(position: Vector3, rollDeg: Double, pitchDeg: Double, yawDeg: Double): Placement =
    import StrictMath.toRadians
    Placement(position, Quaternion.of(toRadians(rollDeg), toRadians(pitchDeg), toRadians(yawDeg)))

/** Scalar and vector products of two vectors. */
extension (a: Vector3)
  private[scene] def dot(b: Vector3): Double    = a.x * b.x + a.y * b.y + a.z * b.z
  private[scene] def cross(b: Vector3): Vector3 =
    Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
