package skein.units

/** A place on the Earth, which is a sphere as in AirSim: degrees from the equator and from Greenwich, and
  * height above sea level.
  */
final case class GeoLocation(latitudeDeg: Double, longitudeDeg: Double, altitude: Metres):

  /** The geographic location of a point in NED, m, relative to this location. */
  def locate(pointNed: Vector3): GeoLocation =
    val up    = Metres(altitude.value - pointNed.z)
    val north = pointNed.x / GeoLocation.EarthRadiusM
    val east  = pointNed.y / GeoLocation.EarthRadiusM
    val angle = StrictMath.hypot(north, east)
    if angle < 1e-12 then copy(altitude = up)
    else
      val latitude = math.toRadians(latitudeDeg)
      val sine     = StrictMath.sin(angle) / angle
      val there    = StrictMath.asin(
        StrictMath.cos(angle) * StrictMath.sin(latitude) + north * sine * StrictMath.cos(latitude)
      )
      val around = StrictMath.atan2(
        east * sine,
        StrictMath.cos(latitude) * StrictMath.cos(angle) - north * StrictMath.sin(latitude) * sine
      )
      GeoLocation(math.toDegrees(there), longitudeDeg + math.toDegrees(around), up)

  /** This location in NED, m, relative to a nearby one (AirSim's `GeodeticToNedFast`). */
  def nedFrom(origin: GeoLocation): Vector3 = Vector3(
    math.toRadians(latitudeDeg - origin.latitudeDeg) * GeoLocation.EarthRadiusM,
    math.toRadians(longitudeDeg - origin.longitudeDeg) * GeoLocation.EarthRadiusM * StrictMath.cos(
      math.toRadians(latitudeDeg)
    ),
    origin.altitude.value - altitude.value
  )

object GeoLocation:
  val EarthRadiusM = 6378137.0
