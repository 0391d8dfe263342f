package skein.ros

import skein.units.{Quaternion, Vector3}

/** Converts between Skein's frames, which are those of AirSim and MAVLink (world: north, east, down; body:
  * front, right, down), and those of ROS (REP 103; world: east, north, up; body: front, left, up).
  */
object RosFrames:

  /** Converts a position or velocity from NED to ENU, or from ENU to NED. */
  def swapWorld(ned: Vector3): Vector3 = Vector3(ned.y, ned.x, -ned.z)

  /** Converts a vector from FRD to FLU, or from FLU to FRD. */
  def swapBody(frd: Vector3): Vector3 = Vector3(frd.x, -frd.y, -frd.z)

  /** Converts the rotation from body FRD to NED to that from body FLU to ENU; w is not negative. */
  def toEnu(nedFromFrd: Quaternion): Quaternion = upright(WorldSwap * nedFromFrd * BodySwap)

  /** Converts the rotation from body FLU to ENU to that from body FRD to NED; w is not negative. */
  def toNed(enuFromFlu: Quaternion): Quaternion = upright(WorldSwap * enuFromFlu * BodySwap)

  /** The heading, rad from north towards east, of a rotation from body FLU to ENU. */
  def heading(enuFromFlu: Quaternion): Double = toNed(enuFromFlu).yawRad

  /** Converts a velocity in the level FLU frame, which turns with the heading, to NED. */
  def fromLevel(flu: Vector3, headingRad: Double): Vector3 =
    val (cos, sin) = (StrictMath.cos(headingRad), StrictMath.sin(headingRad))
    Vector3(flu.x * cos + flu.y * sin, flu.x * sin - flu.y * cos, -flu.z)

  private def upright(q: Quaternion) = if q.w < 0 then Quaternion(-q.w, -q.x, -q.y, -q.z) else q

  /** Half a turn about the horizontal diagonal between the world's first two axes. */
  private val WorldSwap = Quaternion(0, math.sqrt(0.5), math.sqrt(0.5), 0)

  /** Half a turn about the front axis, which both bodies share. */
  private val BodySwap = Quaternion(0, 1, 0, 0)
