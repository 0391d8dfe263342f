package skein.simulator

import skein.airsim.wire.*
import upack.*
import upickle.default.writeMsg

class AppearanceMethodsSuite extends munit.FunSuite:

  private val red            = Arr(Float32(1), Float32(0), Float32(0), Float32(1))
  private def points(n: Int) = Arr(Seq.fill(n)(writeMsg(Vector3r(1, 2, 3)))*)

  test("lists that AirSim would read beyond their end are refused"):
    val bench = Bench()
    assert(bench.error(
      "simPlotPoints",
      points(1),
      Arr(),
      Float32(1),
      Float32(1),
      Bool(false)
    ).contains("RGBA"))
    assert(
      bench
        .error("simPlotArrows", points(1), points(2), red, Float32(5), Float32(2), Float32(-1), Bool(true))
        .contains("1 and 2")
    )
    assert(bench.error("simPlotStrings", Arr(), points(1), Float32(5), red, Float32(1)).contains("0 and 1"))
    assert(bench.error("simSetTraceLine", Arr(Float32(1)), Float32(1), Str("")).contains("RGBA"))
    assert(bench.error("simPrintLogMessage", Str("a" * 20_000), Str(""), Int32(0)).contains("at most 10000"))

  test("functions with only a visible effect are accepted as AirSim accepts them"):
    val bench = Bench()
    bench.tell("simPlotPoints", points(2), red, Float32(10), Float32(5), Bool(false))
    bench.tell("simPlotArrows", points(1), points(1), red, Float32(5), Float32(2), Float32(-1), Bool(true))
    bench.tell("simFlushPersistentMarkers")
    bench.tell("simEnableWeather", Bool(true))
    bench.tell("simSetWeatherParameter", Int32(7), Float32(0.25f))
    bench.tell(
      "simSetTimeOfDay",
      Bool(true),
      Str("2018-02-12 15:20:00"),
      Bool(false),
      Float32(1),
      Float32(60),
      Bool(true)
    )
    bench.tell("simSetTraceLine", red, Float32(5), Str("Evader"))
    bench.tell("simPrintLogMessage", Str("Iteration: "), Str("3"), Int32(0))
    assertEquals(bench.now[Boolean]("simRunConsoleCommand", Str("stat fps")), true)
    assert(bench.error("simSetWeatherParameter", Int32(9), Float32(1)).contains("0 to 8"))

  test("recording is on or off, as a client last set it"):
    val bench = Bench()
    assertEquals(bench.now[Boolean]("isRecording"), false)
    bench.tell("startRecording")
    assertEquals(bench.now[Boolean]("isRecording"), true)
    bench.tell("stopRecording")
    assertEquals(bench.now[Boolean]("isRecording"), false)
