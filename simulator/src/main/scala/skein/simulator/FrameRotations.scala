package skein.simulator

import skein.units.{Quaternion, Vector3}

private[simulator] object FrameRotations:

  /** The components, along the body's axes, of a vector given in the world. */
  def intoBody(v: Vector3, q: Quaternion): Vector3 = Vector3(
    (1 - 2 * (q.y * q.y + q.z * q.z)) * v.x + 2 * (q.x * q.y + q.w * q.z) * v.y + 2 * (q.x * q.z - q.w * q.y) * v.z,
    2 * (q.x * q.y - q.w * q.z) * v.x + (1 - 2 * (q.x * q.x + q.z * q.z)) * v.y + 2 * (q.y * q.z + q.w * q.x) * v.z,
    2 * (q.x * q.z + q.w * q.y) * v.x + 2 * (q.y * q.z - q.w * q.x) * v.y + (1 - 2 * (q.x * q.x + q.y * q.y)) * v.z
  )

  /** The components, in the world, of a vector given along the body's axes. */
  def intoWorld(v: Vector3, q: Quaternion): Vector3 = intoBody(v, Quaternion(q.w, -q.x, -q.y, -q.z))

  /** First `inner`, then `outer`: what is turned by `inner` against a body that is turned by `outer`. */
  def composed(outer: Quaternion, inner: Quaternion): Quaternion = Quaternion(
    outer.w * inner.w - outer.x * inner.x - outer.y * inner.y - outer.z * inner.z,
    outer.w * inner.x + outer.x * inner.w + outer.y * inner.z - outer.z * inner.y,
    outer.w * inner.y - outer.x * inner.z + outer.y * inner.w + outer.z * inner.x,
    outer.w * inner.z + outer.x * inner.y - outer.y * inner.x + outer.z * inner.w
  )

  /** The unit quaternion of this direction; that of zero length is no rotation. */
  def normalized(q: Quaternion): Quaternion =
    val length = math.sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z)
    if length == 0 then Quaternion.Identity
    else Quaternion(q.w / length, q.x / length, q.y / length, q.z / length)
