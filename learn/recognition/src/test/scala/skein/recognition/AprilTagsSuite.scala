package skein.recognition

import skein.airsim.Pixels
import skein.rpc.Bytes
import skein.signal.{SplitMix64, Stamped}
import skein.testing.Optimised
import skein.units.*

class AprilTagsSuite extends munit.FunSuite, Optimised:
  private val camera = Pinhole(1280, 720, Radians(math.Pi / 2))
  private val size   = 0.4
  private val tags   = AprilTags(camera, Metres(size))

  private def found(id: Int, positionFrd: Vector3, turned: Double): Vector[Tag] =
    tags.find(TagImage(camera, id, size, positionFrd, turned)).fold(fail(_), identity)

  test(
    "every tag at 2 to 8 m is found, its position within 2 % at the median and within its stated deviation"
  ):
    val random = SplitMix64(1)
    val runs   = Vector.tabulate(36): i =>
      val range  = 2 + 6 * i / 35.0
      val aside  = (random.nextDouble() - 0.5) * range
      val below  = (random.nextDouble() - 0.5) * 0.6 * range
      val place  = Vector3(range, aside, below)
      val turned = (random.nextDouble() - 0.5) * 1.2
      val id     = random.nextInt(587)
      val seen   = found(id, place, turned)
      assertEquals(seen.map(_.id), Vector(id.toLong), s"at $place, turned by $turned")
      (place, seen.head)
    val errors = runs.map((place, tag) => (tag.positionFrd - place).norm / place.norm).sorted
    println(
      f"position error of ${errors.size} tags at 2 to 8 m: median " +
        f"${errors(errors.size / 2) * 100}%.2f %%, largest ${errors.last * 100}%.2f %%"
    )
    assert(errors(errors.size / 2) < 0.02, errors)
    val inDeviations = runs.map: (place, tag) =>
      math.abs(tag.positionFrd.norm - place.norm) / tag.polar.deviation.range.value
    assert(inDeviations.count(_ < 2) > 0.8 * runs.size, inDeviations.sorted)

  test("a tag becomes a measurement at the image's exposure, from the camera's position"):
    val image = TagImage(camera, 7, size, Vector3(4, 0, 0), 0).copy(
      positionNed = Vector3(10, 0, -20),
      orientation = Quaternion(math.sqrt(0.5), 0, 0, math.sqrt(0.5))
    )
    val exposed  = Instant.ofNanos(5)
    val measured =
      tags.find(image).fold(fail(_), identity).head.measured(Stamped(image, exposed, exposed, exposed))
    assertEquals(measured.validAt, exposed)
    assert((measured.positionNed - Vector3(10, 4, -20)).norm < 0.08, measured)
    assert(measured.covariance.yy > measured.covariance.xx, "the range is less certain than the bearing")

  test("nothing is found in an empty image, and an image of another camera is refused"):
    val grey  = TagImage(camera, 7, size, Vector3(-4, 0, 0), 0)
    val blank = grey.copy(pixels = Pixels.Bgr(Bytes(new Array[Byte](1280 * 720 * 3), 0, 1280 * 720 * 3)))
    assertEquals(tags.find(blank), Right(Vector.empty))
    assertEquals(
      tags.find(grey.copy(width = 640)),
      Left("expected 1280 × 720 pixels of three bytes, got 640 × 720 in 2764800 bytes")
    )
    assertEquals(
      tags.find(grey.copy(pixels = Pixels.Numbers(Array.emptyFloatArray))),
      Left("expected raw pixels, got Numbers")
    )
