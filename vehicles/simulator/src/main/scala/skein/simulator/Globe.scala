package skein.simulator

import skein.units.{GeoLocation, Vector3}

/** The Earth as AirSim has it: a sphere with a standard atmosphere and a magnetic dipole (`EarthUtils`). */
private[simulator] object Globe:
  /** Standard air pressure at sea level, Pa. */
  val SeaLevelPressure = 101325.0

  /** Standard temperature below 11 km, K. */
  def temperatureK(altitudeM: Double): Double = 288.15 - 6.5 * geopotentialKm(altitudeM)

  /** Standard pressure below 11 km, Pa (Stull, Practical Meteorology). */
  def pressurePa(altitudeM: Double): Double =
    SeaLevelPressure * StrictMath.pow(288.15 / temperatureK(altitudeM), -5.255877)

  /** Standard air density below 11 km, kg/m³. */
  def airDensity(altitudeM: Double): Double = pressurePa(altitudeM) / 287.053 / temperatureK(altitudeM)

  /** Altitude of a pressure, m, by the altimeter formula. */
  def pressureAltitudeM(pressurePa: Double): Double =
    (1 - StrictMath.pow(pressurePa / SeaLevelPressure, 0.190284)) * 145366.45 * 0.3048

  /** The field of a dipole whose pole lies at 80.31° N, 72.62° W, NED, gauss. Its direction errs by some 10°,
    * its strength by up to a third.
    */
  def magneticFieldNed(place: GeoLocation): Vector3 =
    val latitude = math.toRadians(place.latitudeDeg)
    val fromPole = math.toRadians(place.longitudeDeg + 72.62)
    val pole     = math.toRadians(80.31)
    val cosColat =
      StrictMath.cos(latitude) * StrictMath.cos(
        pole
      ) + StrictMath.sin(latitude) * StrictMath.sin(pole) * StrictMath.cos(fromPole)
    val colatitude = StrictMath.acos(cosColat)
    val strength   = 0.312 * StrictMath.pow(
      GeoLocation.EarthRadiusM / (GeoLocation.EarthRadiusM + place.altitude.value),
      3
    ) *
      math.sqrt(1 + 3 * cosColat * cosColat)
    val ratio       = StrictMath.cos(pole) / StrictMath.sin(colatitude)
    val declination =
      if cosColat > StrictMath.sin(pole) * StrictMath.sin(latitude) then
        StrictMath.asin(StrictMath.sin(fromPole) * ratio)
      else StrictMath.asin(StrictMath.cos(fromPole) * ratio)
    val inclination = StrictMath.atan(2 / StrictMath.tan(colatitude))
    Vector3(
      strength * StrictMath.cos(inclination) * StrictMath.cos(declination),
      strength * StrictMath.cos(inclination) * StrictMath.sin(declination),
      strength * StrictMath.sin(inclination)
    )

  private def geopotentialKm(altitudeM: Double): Double =
    val kilometres = altitudeM / 1000
    val radius     = GeoLocation.EarthRadiusM / 1000
    radius * kilometres / (radius + kilometres)
