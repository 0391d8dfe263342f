package skein.settings

class SensorFileSuite extends munit.FunSuite:
  private val whole = Map(
    "every-s"              -> "0.1",
    "fov-deg"              -> "90",
    "farthest-m"           -> "60",
    "detection.value"      -> "0.95",
    "bearing-sd-deg.value" -> "0.5",
    "range-bias.value"     -> "1",
    "range-sd.value"       -> "0.05",
    "takes-ms"             -> "[20, 30, 40]",
    "workers"              -> "1",
    "deadline-s"           -> "0.3"
  )

  private def read(changed: (String, String)*) =
    val lines = (whole ++ changed).map((key, value) => s"$key = $value")
    SensorFile.parse(lines.mkString("skein.sensor {\n", "\n", "\n}"), "sensor.conf")

  test("a recognition that ends before it began is reported as the mistake"):
    assert(
      read("takes-ms" -> "[-5]").left.exists(_.contains("takes no negative time")),
      read("takes-ms" -> "[-5]")
    )

  test("a file with valid values is read as a sensor"):
    assert(read().isRight, read())

  for
    (key, value, mistake) <- Seq(
      ("every-s", "1e-7", "expected a millisecond or more between images, got 1.0E-7 s"),
      ("farthest-m", "-1", "expected a positive largest range, got -1.0 m"),
      ("detection.value", "1.5", "expected a detection between 0 and 1, got 1.5"),
      ("range-bias.value", "0", "expected a positive bias of the range, of 1 where it is exact, got 0.0"),
      ("workers", "0", "expected at least one worker, got 0")
    )
  do
    test(s"$key = $value is reported as the mistake"):
      assertEquals(read(key -> value), Left(s"sensor.conf: $mistake"))
