package skein.hil

import skein.units.{GeoLocation, Vector3}

/** The Earth's magnetic field: the International Geomagnetic Reference Field of its 13th generation (Alken et
  * al., Earth, Planets and Space 73:49, 2021) at its epoch 2020, up to degree 6, on a spherical Earth at sea
  * level. Autopilots correct their heading by such a model; a dipole's direction errs by tens of degrees.
  * This one errs by some 2° where people live, and by 0.02 gauss (`MagneticFieldSuite`).
  */
object MagneticField:

  /** The field at a place: NED, gauss. At the poles, where north is undefined, the field 1 m beside them. */
  def ned(place: GeoLocation): Vector3 =
    val colatitude = math.toRadians(90 - place.latitudeDeg).max(1e-7).min(math.Pi - 1e-7)
    val longitude  = math.toRadians(place.longitudeDeg)
    val cos        = StrictMath.cos(colatitude)
    val sin        = StrictMath.sin(colatitude)
    // Schmidt's semi-normalised Legendre functions of the colatitude, and their derivatives.
    val p = Array.ofDim[Double](Degree + 1, Degree + 1)
    val d = Array.ofDim[Double](Degree + 1, Degree + 1)
    p(0)(0) = 1
    var (north, east, down) = (0.0, 0.0, 0.0)
    var shrink              = RadiusRatio * RadiusRatio
    for n <- 1 to Degree do
      shrink *= RadiusRatio
      for m <- 0 to n do
        if m == n then
          val k = if n == 1 then 1.0 else math.sqrt(1 - 0.5 / n)
          p(n)(n) = k * sin * p(n - 1)(n - 1)
          d(n)(n) = k * (sin * d(n - 1)(n - 1) + cos * p(n - 1)(n - 1))
        else
          val root = math.sqrt(n * n - m * m)
          val a    = (2 * n - 1) / root
          val b    = if m > n - 2 then 0.0 else math.sqrt((n - 1) * (n - 1) - m * m) / root
          p(n)(m) = a * cos * p(n - 1)(m) - (if b == 0 then 0 else b * p(n - 2)(m))
          d(n)(m) = a * (cos * d(n - 1)(m) - sin * p(n - 1)(m)) - (if b == 0 then 0 else b * d(n - 2)(m))
        val (g, h) = Coefficients(n * (n + 1) / 2 - 1 + m)
        val c      = StrictMath.cos(m * longitude)
        val s      = StrictMath.sin(m * longitude)
        north += shrink * (g * c + h * s) * d(n)(m)
        east += shrink * m * (g * s - h * c) * p(n)(m) / sin
        down -= shrink * (n + 1) * (g * c + h * s) * p(n)(m)
    Vector3(north, east, down) * GaussPerNanotesla

  private val Degree = 6

  private val GaussPerNanotesla = 1e-5

  /** Radius of the model's sphere over the Earth's. */
  private val RadiusRatio = 6371.2e3 / GeoLocation.EarthRadiusM

  /** The coefficients g and h, nT: for n from 1, each for m from 0 to n. */
  private val Coefficients: Vector[(Double, Double)] = Vector(
    (-29404.8, 0),
    (-1450.9, 4652.5),
    (-2499.6, 0),
    (2982.0, -2991.6),
    (1677.0, -734.6),
    (1363.2, 0),
    (-2381.2, -82.1),
    (1236.2, 241.9),
    (525.7, -543.4),
    (903.0, 0),
    (809.5, 281.9),
    (86.3, -158.4),
    (-309.4, 199.7),
    (48.0, -349.7),
    (-234.3, 0),
    (363.2, 47.7),
    (187.8, 208.3),
    (-140.7, -121.2),
    (-151.2, 32.3),
    (13.5, 98.9),
    (66.0, 0),
    (65.5, -19.1),
    (72.9, 25.1),
    (-121.5, 52.8),
    (-36.2, -64.5),
    (13.5, 8.9),
    (-64.7, 68.1)
  )
