package skein.simulator

import skein.airsim.wire.*
import upack.*
import upickle.default.writeMsg

class AppearanceMethodsSuite extends munit.FunSuite:

  private val red                 = Arr(Float32(1), Float32(0), Float32(0), Float32(1))
  private def points(n: Int)      = Arr(Seq.fill(n)(writeMsg(Vector3r(1, 2, 3)))*)
  private def shown(bench: Bench) =
    bench.simulation.appearance.markers(bench.simulation.world.now).map(_.kind)

  test("markers stay for their time, persistent ones until they are flushed"):
    val bench = Bench()
    bench.tell("simPlotPoints", points(2), red, Float32(10), Float32(5), Bool(false))
    bench.tell("simPlotLineStrip", points(2), red, Float32(10), Float32(-1), Bool(false))
    bench.tell("simPlotArrows", points(1), points(1), red, Float32(5), Float32(2), Float32(-1), Bool(true))
    assertEquals(shown(bench), Seq("simPlotPoints", "simPlotLineStrip", "simPlotArrows"))
    bench.pass(2)
    assertEquals(shown(bench), Seq("simPlotPoints", "simPlotArrows"))
    bench.pass(4)
    assertEquals(shown(bench), Seq("simPlotArrows"))
    bench.tell("simFlushPersistentMarkers")
    assertEquals(shown(bench), Seq.empty)

  test("markers are bounded, in number and in points, and those dropped are counted"):
    val bench = Bench()
    for _ <- 1 to Appearance.MostMarkers + 5 do
      bench.tell("simPlotPoints", points(1), red, Float32(10), Float32(-1), Bool(true))
    assertEquals(shown(bench).size, Appearance.MostMarkers)
    assertEquals(bench.simulation.appearance.droppedMarkers, 5L)
    bench.tell(
      "simPlotPoints",
      points(Appearance.MostPoints.toInt),
      red,
      Float32(10),
      Float32(-1),
      Bool(true)
    )
    assertEquals(shown(bench).size, 1)

  test("what AirSim would read past the end of is refused"):
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

  test("weather, sun, trace, messages and commands are kept"):
    val bench = Bench()
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
    for i <- 1 to 3 do bench.tell("simPrintLogMessage", Str("Iteration: "), Str(s"$i"), Int32(0))
    bench.tell("simRunConsoleCommand", Str("stat fps"))
    val appearance = bench.simulation.appearance
    assert(appearance.weather)
    assertEquals(appearance.effects.toMap, Map(7 -> 0.25f))
    assertEquals(appearance.sun.map(_.start), Some("2018-02-12 15:20:00"))
    assertEquals(appearance.traces.get(0).map(_.thickness), Some(5f))
    assertEquals(appearance.log, Seq(Appearance.Line("Iteration: ", "3", 0)))
    assertEquals(appearance.commands.newest, Seq("stat fps"))
    assert(bench.error("simSetWeatherParameter", Int32(9), Float32(1)).contains("0 to 8"))

  test("messages and commands are bounded"):
    val bench = Bench()
    for i <- 1 to 250 do
      bench.tell("simPrintLogMessage", Str(s"$i"), Str(""), Int32(0))
      bench.tell("simRunConsoleCommand", Str(s"$i"))
    assertEquals(bench.simulation.appearance.log.map(_.message), (151 to 250).map(_.toString))
    assertEquals(bench.simulation.appearance.commands.newest, (151 to 250).map(_.toString))
    assertEquals(bench.simulation.appearance.commands.count, 250L)

  test("recording is on or off, as it was told"):
    val bench = Bench()
    assertEquals(bench.now[Boolean]("isRecording"), false)
    bench.tell("startRecording")
    assertEquals(bench.now[Boolean]("isRecording"), true)
    bench.tell("stopRecording")
    assertEquals(bench.now[Boolean]("isRecording"), false)
