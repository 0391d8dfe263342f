package skein.fusion

import skein.signal.{NormalQuantile, SplitMix64}
import skein.units.*

class PolarMeasurementSuite extends munit.FunSuite:
  private val sharp   = (azimuth = Radians(0.001), elevation = Radians(0.002), range = Metres(0.1))
  private val quarter = math.sqrt(0.5)

  private def near(came: Vector3, expected: Vector3)(using munit.Location) =
    assert((came - expected).norm < 1e-9, s"$came, expected $expected")

  test("a point is converted to angles and range, and back"):
    for point <- List(Vector3(5, 0, 0), Vector3(3, 4, -2), Vector3(-1, 2, 0.5)) do
      near(
        PolarMeasurement.of(
          point,
          sharp
        ).seenFrom(Instant.Epoch, Vector3.Zero, Quaternion.Identity).positionNed,
        point
      )

  test("for a sensor that faces east, right is south, and a positive elevation is up"):
    val east               = Quaternion(quarter, 0, 0, quarter)
    def seen(frd: Vector3) =
      PolarMeasurement.of(frd, sharp).seenFrom(Instant.Epoch, Vector3(10, 0, -20), east).positionNed
    near(seen(Vector3(5, 0, 0)), Vector3(10, 5, -20))
    near(seen(Vector3(5, 1, 0)), Vector3(9, 5, -20))
    near(seen(Vector3(5, 0, -1)), Vector3(10, 5, -21))

  test(
    "straight ahead, the range determines the variance along the line of sight, and the angles that across it"
  ):
    val seen =
      PolarMeasurement.of(Vector3(10, 0, 0), sharp).seenFrom(Instant.Epoch, Vector3.Zero, Quaternion.Identity)
    assertEqualsDouble(seen.covariance.xx, 0.01, 1e-12)
    assertEqualsDouble(seen.covariance.yy, 1e-4, 1e-12)
    assertEqualsDouble(seen.covariance.zz, 4e-4, 1e-12)

  test("the covariance is that of randomly drawn points"):
    val random = SplitMix64(1)
    def normal = NormalQuantile(random.nextDouble().max(1e-9))
    val turn   = Quaternion(0.5, 0.5, -0.5, 0.5)
    val middle = PolarMeasurement.of(
      Vector3(7, -3, 2),
      (azimuth = Radians(0.01), elevation = Radians(0.02), range = Metres(0.3))
    )
    val seen  = middle.seenFrom(Instant.Epoch, Vector3.Zero, turn)
    val drawn = Vector.fill(40_000):
      val one = middle.copy(
        azimuth = Radians(middle.azimuth.value + 0.01 * normal),
        elevation = Radians(middle.elevation.value + 0.02 * normal),
        range = Metres(middle.range.value + 0.3 * normal)
      )
      one.seenFrom(Instant.Epoch, Vector3.Zero, turn).positionNed - seen.positionNed
    val sampled = drawn.map(Matrix3.along).reduce(_ + _) * (1.0 / drawn.size)
    val off     = sampled - seen.covariance
    val largest = List(off.xx, off.xy, off.xz, off.yy, off.yz, off.zz).map(math.abs).max
    assert(largest < 0.003, s"$sampled, expected ${seen.covariance}")
