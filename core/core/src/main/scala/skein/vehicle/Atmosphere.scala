package skein.vehicle

/** International Standard Atmosphere (ISO 2533), lowest layer. */
object Atmosphere:
  /** Density of air at sea level in the standard atmosphere, kg/m³. */
  val SeaLevelDensity = 1.225

  /** Temperature lapse rate divided by the temperature at sea level, 1/m: 0.0065 K/m over 288.15 K. */
  private val Lapse = 0.0065 / 288.15

  /** g·M/(R·L) − 1: the exponent of the density's power law. */
  private val Exponent = 9.80665 * 0.0289644 / (8.31446 * 0.0065) - 1

  private val C1 = -Exponent
  private val C2 = C1 * (1 - Exponent) / 2
  private val C3 = C2 * (2 - Exponent) / 3
  private val C4 = C3 * (3 - Exponent) / 4

  /** Density at an altitude divided by that at sea level: (1 − L·h/T₀)^4.256 by its binomial series to the
    * fourth power, because `pow` at every step would cost more than the rest of a vehicle's drag. Error below
    * 1e-8 up to 2 km, below 1e-4 up to 11 km.
    */
  def densityRatio(altitudeM: Double): Double =
    val x = Lapse * altitudeM
    1 + x * (C1 + x * (C2 + x * (C3 + x * C4)))

  /** Coefficients of the density ratio's series in the altitude, 1/m and 1/m²; error below 1e-6 up to 500 m.
    */
  private[skein] val slope: Double     = Lapse * C1
  private[skein] val curvature: Double = Lapse * Lapse * C2
