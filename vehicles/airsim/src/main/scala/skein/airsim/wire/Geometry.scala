package skein.airsim.wire

import skein.units.{GeoLocation, Metres, Quaternion, Vector3}

/** AirSim's vector: 32-bit components, in the frame and unit of the field that holds it. */
final private[skein] case class Vector3r(x_val: Float, y_val: Float, z_val: Float) derives Fields:
  def toVector: Vector3 = Vector3(x_val, y_val, z_val)

private[skein] object Vector3r:
  val Zero: Vector3r = Vector3r(0, 0, 0)

  def apply(v: Vector3): Vector3r = Vector3r(v.x.toFloat, v.y.toFloat, v.z.toFloat)

/** AirSim's quaternion: the rotation from body FRD to NED. */
final private[skein] case class Quaternionr(w_val: Float, x_val: Float, y_val: Float, z_val: Float)
    derives Fields:
  def toQuaternion: Quaternion = Quaternion(w_val, x_val, y_val, z_val)

private[skein] object Quaternionr:
  def apply(q: Quaternion): Quaternionr = Quaternionr(q.w.toFloat, q.x.toFloat, q.y.toFloat, q.z.toFloat)

/** A pose: position in m, from the vehicle's own start, NED. */
final private[skein] case class Pose(position: Vector3r, orientation: Quaternionr) derives Fields

private[skein] object Pose:
  def apply(position: Vector3, orientation: Quaternion): Pose =
    Pose(Vector3r(position), Quaternionr(orientation))

/** Degrees and metres above sea level; latitude and longitude are 64-bit on the wire. */
final private[skein] case class GeoPoint(latitude: Double, longitude: Double, altitude: Float)
    derives Fields:
  def toLocation: GeoLocation = GeoLocation(latitude, longitude, Metres(altitude))

private[skein] object GeoPoint:
  def apply(place: GeoLocation): GeoPoint =
    GeoPoint(place.latitudeDeg, place.longitudeDeg, place.altitude.value.toFloat)
