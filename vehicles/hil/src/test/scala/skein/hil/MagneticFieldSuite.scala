package skein.hil

import skein.units.*

class MagneticFieldSuite extends munit.FunSuite:

  /** NOAA and BGS, "The US/UK World Magnetic Model for 2020-2025", table of test values: at sea level in
    * 2020.0.
    */
  private val published = Seq(
    (80.0, 0.0, Vector3(6570.4, -146.3, 54606.0)),
    (0.0, 120.0, Vector3(39624.3, 109.9, -10932.5)),
    (-80.0, 240.0, Vector3(5940.6, 15772.1, -52480.8))
  )

  test("the field deviates from the World Magnetic Model's test values by less than 0.02 gauss"):
    for (latitude, longitude, nanotesla) <- published do
      val field = MagneticField.ned(GeoLocation(latitude, longitude, Metres(0)))
      val off   = (field - nanotesla * 1e-5).norm
      assert(off < 0.02, s"at $latitude, $longitude: $field, off by $off gauss")

  test("the field is finite everywhere, including the poles"):
    for latitude <- -90 to 90 by 10; longitude <- -180 to 180 by 20 do
      val field = MagneticField.ned(GeoLocation(latitude, longitude, Metres(0)))
      assert(field.norm > 0.2 && field.norm < 0.7, s"at $latitude, $longitude: $field")
