package skein.simulator

import skein.units.*
import upack.{Bool, Int32, Str}

class TimeSuite extends munit.FunSuite:

  private def flight(advance: Bench => Unit): (Vector3, Instant) =
    val bench = Bench().hovering(-20)
    bench.tell("simPause", Bool(true))
    bench.velocityZ(10, 0, -20, 10)
    advance(bench)
    (bench.position(), bench.stamp())

  test("a paused simulator stands still, answers getters and accepts commands that wait"):
    val bench = Bench().hovering(-20)
    bench.tell("simPause", Bool(true))
    val before = (bench.position(), bench.stamp())
    val move   = bench.velocityZ(10, 0, -20, 1)
    bench.pass(5)
    assertEquals((bench.position(), bench.stamp()), before)
    assertEquals(bench.now[Boolean]("simIsPaused"), true)
    assertEquals(bench.simulation.nextWake(Instant.ofNanos(0)), None)
    assertEquals(bench.result(move), None)
    bench.tell("simPause", Bool(false))
    bench.pass(1.01)
    assertEquals(bench.result(move), Some(true))
    assert(bench.position().x > 0.5)

  test("continueForTime(0.1) advances the simulator's clock by exactly 0.1 s, and answers"):
    val bench = Bench().hovering(-20)
    bench.tell("simPause", Bool(true))
    bench.velocityZ(10, 0, -20, 10)
    for _ <- 1 to 30 do
      val before = bench.stamp()
      val step   = bench.continueFor(0.1)
      assert(bench.answerOf(step).isRight)
      assertEquals(bench.stamp().since(before), Span.ofMillis(100))
      assertEquals(bench.now[Boolean]("simIsPaused"), true)
      bench.pass(0.01)

  test("dividing time into pieces does not change the flight"):
    val whole  = flight(bench => bench.continueFor(3.0): Unit)
    val tenths = flight(bench => for _ <- 1 to 30 do bench.continueFor(0.1))
    val ran    = flight: bench =>
      bench.tell("simPause", Bool(false))
      bench.pass(3)
    assertEquals(tenths, whole)
    assertEquals(ran, whole)

  test("a frame lasts 1/60 s, as of a renderer at 60 Hz"):
    val bench  = Bench().hovering(-20)
    val before = { bench.tell("simPause", Bool(true)); bench.stamp() }
    bench.tell("simContinueForFrames", Int32(10))
    assertEquals(bench.stamp().since(before), Span.ofSeconds(10 / 60.0))

  test("at a speed of ten the simulator's clock runs ten times as fast"):
    val bench = Bench(speed = 10).hovering(-20)
    val move  = bench.velocityZ(10, 0, -20, 10)
    bench.pass(1.001)
    assertEquals(bench.result(move), Some(true))
    assertEqualsDouble(bench.simulatedS, 10.01, 1e-6)

  test("time that is too long to compute in one call is skipped and counted"):
    val bench = Bench()
    bench.simulation.advance(Instant.ofNanos(1_000_000_000L) + Span.ofSeconds(1000))
    assertEqualsDouble(bench.simulation.behind.toSeconds, 400, 1e-6)
    assertEqualsDouble(bench.simulatedS, 600, 1e-6)

  test("a long step is computed in pieces, and other calls are answered meanwhile"):
    val bench = Bench()
    bench.tell("simPause", Bool(true))
    val step = bench.continueFor(1000)
    assertEquals(bench.answeredAt(step), None)
    assertEquals(bench.now[Boolean]("ping"), true)
    bench.pass(0)
    assert(bench.answeredAt(step).nonEmpty)
    assertEqualsDouble(bench.simulatedS, 1000, 1e-9)

  test("readings between two steps of physics are extrapolated to the clock"):
    val bench = Bench().hovering(-20)
    bench.velocity(5, 0, 0, 10)
    bench.pass(5.001)
    bench.tell("simPause", Bool(true))
    val (here, speed) = (bench.position(), bench.kinematics().linear_velocity.x_val)
    bench.continueFor(0.001)
    assertEqualsDouble(bench.position().x - here.x, speed * 0.001, 2e-6)

  test("two runs with equal calls are equal to the last bit"):
    def run(): Seq[skein.airsim.wire.KinematicsState] =
      val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
      for i <- 1 to 50 yield
        bench.velocityZ(5 * math.cos(i * 0.1), 5 * math.sin(i * 0.1), -20, 10)
        bench.velocityZ(10, i * 0.2, -20, 10, "Pursuer")
        bench.pass(0.0973)
        bench.kinematics("Pursuer")
    assertEquals(run(), run())

  test("a vehicle's state can be read by the empty name, too"):
    val bench = Bench(Seq("Evader", "Pursuer"))
    assertEquals(bench.now[Seq[String]]("listVehicles"), Seq("Evader", "Pursuer"))
    assertEquals(bench.kinematics(""), bench.kinematics("Evader"))
    assertEquals(bench.now[Boolean]("isApiControlEnabled", Str("")), false)
