package skein.recognition

import java.nio.ByteBuffer
import java.nio.file.Path
import skein.testing.Optimised

/** Tests the shipped detector on images of a seed that its training did not use; `measureDetector` uses more
  * images.
  */
class VehicleDetectorSuite extends munit.FunSuite, Optimised:
  private val camera = DetectorAccuracy.Camera

  test("quadrotors at 2 to 15 m are found, with few false detections and errors of the stated size"):
    val seed   = 20261123L
    val result = DetectorAccuracy.measured(Seq((2.0, 6.0), (6.0, 15.0)), count = 25, seed)
    assert(result.recall > 0.85, s"seed $seed: recall ${result.recall}")
    // For some forty boxes; 0.94 for all of 1200 images.
    assert(result.precision > 0.85, s"seed $seed: precision ${result.precision}")
    // The nearer the larger, and the farther the box's middle from the quadrotor's.
    for ((range, row), mostDeg) <- result.byRange.zip(Seq(1.0, 0.4)) do
      val median = row.bearingsDeg(row.bearingsDeg.size / 2)
      assert(median < mostDeg, s"seed $seed: $range m: $median°")
      val within = row.inDeviations.count(math.abs(_) < 2).toDouble / row.inDeviations.size
      assert(within > 0.85, s"seed $seed: $range m: ${row.inDeviations}")

  test("a box's position gives its bearing, and one cut by the border is less certain"):
    val detector = VehicleDetector.shipped(camera).fold(fail(_), identity)
    val ahead    = detector.polar(Box(380, 290, 420, 310, 0, 1))
    assertEqualsDouble(ahead.azimuth.value, 0, 1e-9)
    assertEqualsDouble(ahead.elevation.value, 0, 1e-9)
    val aside = detector.polar(Box(580, 190, 620, 210, 0, 1))
    assert(aside.azimuth.value > 0.4 && aside.elevation.value > 0.2, aside)
    val cut = detector.polar(Box(0, 290, 40, 310, 0, 1))
    assert(cut.deviation.range.value >= cut.range.value, cut)

  test("an image of another camera, and an invalid model, are reported"):
    val detector = VehicleDetector.shipped(camera).fold(fail(_), identity)
    assertEquals(
      detector.find(640, 480, ByteBuffer.allocate(640 * 480 * 3)).left.toOption,
      Some("expected 800 × 600 pixels, got 640 × 480")
    )
    assertEquals(
      BlindPursuit(recogniser = "missing.onnx").mistakes,
      Seq(
        "recogniser: expected tags, detector or an ONNX file: " +
          "missing.onnx: expected an ONNX model, there is no such file"
      )
    )
    assert(VehicleDetector.load(camera, Path.of("missing.onnx")).isLeft)
