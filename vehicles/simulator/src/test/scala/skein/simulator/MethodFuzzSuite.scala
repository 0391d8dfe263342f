package skein.simulator

import scala.util.Random
import skein.airsim.wire.MultirotorReading
import skein.scene.SceneFile
import upack.{Bool, Msg, Str}

/** Fuzzes every method without sockets and threads; a short version of [[Siege]]. */
class MethodFuzzSuite extends munit.FunSuite:
  private val vehicles = Seq("Evader", "Pursuer")
  private val scene    = SceneFile.named("street").get
  private val carrying =
    """{"DefaultSensors": {"L": {"SensorType": 6, "Enabled": true, "PointsPerSecond": 2000},
      |  "D": {"SensorType": 5, "Enabled": true}}, "Vehicles": {"Evader": {}, "Pursuer": {}},
      |  "CameraDefaults": {"CaptureSettings": [{"Width": 40, "Height": 24}]}}""".stripMargin
  private val calls = MethodFuzz.Calls(Simulation.methods, vehicles.head)

  /** Checks that every call is answered: immediately, except for moves, which end by the next move of their
    * vehicle or by a cancellation.
    */
  private def fuzz(all: Iterator[MethodFuzz.FuzzCall], clue: String): Int =
    val bench  = Bench(vehicles, overload = Overload.Never, scene = scene, text = carrying).ready()
    var tokens = Vector.empty[(Long, MethodFuzz.FuzzCall)]
    var count  = 0
    for call <- all do
      tokens :+= bench.call(call.method, call.params*) -> call
      count += 1
      if count % 50 == 0 then
        // Ends a stepped advance, which may have been requested to last a day.
        bench.tell("simPause", Bool(false))
        bench.pass(0.003)
        // An honest client at the same simulator.
        val reading = bench.now[MultirotorReading]("getMultirotorState", Str("Pursuer"))
        assert(reading.timestamp == bench.simulation.world.now, clue)
      if count % 1000 == 0 then
        tokens = settle(bench, tokens, clue)
    settle(bench, tokens, clue)
    count

  private def settle(
      bench: Bench,
      tokens: Vector[(Long, MethodFuzz.FuzzCall)],
      clue: String
  ): Vector[(Long, MethodFuzz.FuzzCall)] =
    bench.tell("simPause", Bool(false))
    vehicles.foreach(name => bench.tell("cancelLastTask", Str(name)))
    for (token, call) <- tokens do
      assert(bench.isAnswered(token), s"never answered: ${short(call)}, $clue")
      for text <- bench.answerOf(token).left do
        assert(!MethodFuzz.isDefect(text), s"$text: ${short(call)}, $clue")
    Vector.empty

  private def short(call: MethodFuzz.FuzzCall): String =
    s"${call.method}(${call.params.map((value: Msg) => value.toString.take(60)).mkString(", ")})"

  test("calls with a parameter that is nil, of another type, not finite, huge or deep are all answered"):
    val count = fuzz(calls.each, "each in turn")
    assert(count > 5000, count)

  test("5,000 random calls, with missing and surplus parameters, are all answered"):
    val seed   = 1L
    val random = Random(seed)
    assertEquals(fuzz(Iterator.fill(5_000)(calls.random(random)), s"seed $seed"), 5_000)
