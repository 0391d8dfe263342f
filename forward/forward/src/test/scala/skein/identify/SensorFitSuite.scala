package skein.identify

import skein.signal.SplitMix64

class SensorFitSuite extends munit.FunSuite:
  private val random = SplitMix64(5)

  private def normal(deviation: Double) =
    deviation * math.sqrt(-2 * StrictMath.log(1 - random.nextDouble())) *
      StrictMath.cos(2 * math.Pi * random.nextDouble())

  private def seeing(detections: Int) = Seeing(
    everyS = 0.1,
    fovRad = 1.7,
    workers = 2,
    deadlineS = 0.3,
    images = 1000,
    readings = 1000,
    // In view for 80 % of the time, and for another 15 % beyond what it detects.
    inViewM = Vector.fill(800)(5.0) ++ Vector.fill(150)(40.0),
    Vector.fill(detections):
      val range = 5 + 10 * random.nextDouble()
      Detected(normal(0.004), range * (1.05 + normal(0.08)), range, 15 + 105 * random.nextDouble())
  )

  test("the parameters of a sensor are found again from its detections, within their intervals"):
    val fit   = SensorFit.of(Vector(seeing(700))).fold(fail(_), identity)
    val truth = Map(
      "detection"      -> 0.875,
      "bearing-sd-deg" -> StrictMath.toDegrees(0.004),
      "range-bias"     -> 1.05,
      "range-sd"       -> 0.08 / 1.05
    )
    for parameter <- fit.fitted do
      val value = truth(parameter.name)
      assert(parameter.least < value && value < parameter.most, s"$parameter, truly $value")
      assert(parameter.most - parameter.least < 0.2 * value, s"$parameter")
    assertEqualsDouble(fit.model.takes.quantile(0.5).toMillis, 67.5, 6)
    assertEqualsDouble(fit.model.farthestM, 15, 0.2)

  test("too few detections, or flights with several kinds of cameras, are refused"):
    assertEquals(
      SensorFit.of(Vector(seeing(29))).left.map(identity),
      Left("expected at least 30 detections to identify a sensor, got 29")
    )
    assertEquals(
      SensorFit.of(Vector(seeing(40), seeing(40).copy(everyS = 0.2))).left.map(identity),
      Left("expected flights with one kind of eye, got several")
    )
