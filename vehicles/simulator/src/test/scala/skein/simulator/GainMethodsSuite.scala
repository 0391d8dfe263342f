package skein.simulator

import upack.*

class GainMethodsSuite extends munit.FunSuite:

  private def list(numbers: Double*): Msg = Arr(numbers.map(number => Float32(number.toFloat))*)

  private def speedAfter(bench: Bench, seconds: Double): Double =
    bench.velocity(5, 0, 0, 60)
    bench.pass(seconds)
    bench.kinematics().linear_velocity.x_val

  private def hovering = Bench().hovering(-20)

  test("velocity gains change how fast a vehicle responds"):
    val default = speedAfter(hovering, 0.5)
    val tuned   = hovering
    tuned.tell("setVelocityControllerGains", list(0.1, 0.2, 2), list(0, 0, 2), list(0, 0, 0), Str(""))
    assert(speedAfter(tuned, 0.5) < 0.8 * default)

  test("an integral gain removes the error that drag causes"):
    val tuned = hovering
    tuned.tell(
      "setVelocityControllerGains",
      list(0.2, 0.2, 2),
      list(0.05, 0, 2),
      list(0, 0, 0),
      Str("Evader")
    )
    assertEqualsDouble(speedAfter(tuned, 30), 5, 0.02)

  test("gains of angle, rate and position also change flights, and affect only their own vehicle"):
    val changes =
      Seq("setAngleLevelControllerGains", "setAngleRateControllerGains", "setPositionControllerGains")
    for change <- changes do
      val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
      bench.tell(change, list(0.1, 0.1, 0.1), list(0, 0, 0), list(0, 0, 0), Str("Evader"))
      for name <- Seq("Evader", "Pursuer") do bench.velocityZ(3, 0, -25, 1, name)
      bench.pass(1.5)
      assertNotEquals(bench.position("Evader"), bench.position("Pursuer"), change)

  test("the client's default gains fly like AirSim's own gains, and survive a reset"):
    val bench = hovering
    bench.tell("setVelocityControllerGains", list(0.2, 0.2, 2), list(0, 0, 2), list(0, 0, 0), Str(""))
    assertEqualsDouble(speedAfter(bench, 3), speedAfter(hovering, 3), 0.01)
    bench.tell("setVelocityControllerGains", list(0.1, 0.1, 2), list(0, 0, 2), list(0, 0, 0), Str(""))
    bench.tell("reset")
    assertEquals(bench.simulation.world.multirotor(0).gains.velocity.first.p, 0.1f.toDouble)

  test("lists that are too short are refused"):
    val refusal =
      hovering.error("setPositionControllerGains", list(1, 1), list(0, 0, 0), list(0, 0, 0), Str(""))
    assert(refusal.contains("three lists of three numbers"), refusal)
