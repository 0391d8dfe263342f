package skein.units

/** Degrees from the equator and from Greenwich, and height above sea level. */
final case class GeoLocation(latitudeDeg: Double, longitudeDeg: Double, altitude: Metres)
