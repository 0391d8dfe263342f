package skein.simulator

import skein.units.*
import upack.{Arr, Bool, Float32, Int32, Int64, Msg, Str}
import upickle.default.writeMsg
import skein.airsim.wire.YawMode

class PlanMethodsSuite extends munit.FunSuite:

  extension (bench: Bench)
    /** An action that flies north from a time on, s since the start. */
    private def north(fromS: Double, mps: Double, lastsS: Double = 1): Msg =
      val at     = Instant.ofNanos(1_000_000_000L) + Span.ofSeconds(fromS)
      val params = Seq(mps, 0, -20, lastsS).map(number => Float32(number.toFloat)) ++
        Seq(Int32(0), writeMsg(YawMode.Still))
      Arr(Int64(at.toNanos), Str("moveByVelocityZ"), Arr(params*))

    private def follow(sequence: Long, actions: Msg*): Long =
      bench.call("skeinFollowPlan", Int64(sequence), Arr(actions*), Str("Evader"))

    private def northMps: Double = bench.simulation.world.vehicles(0).velocityAt(bench.simulation.world.now).x

  test("a plan is answered immediately, and flies as moves called at its times do"):
    val (planned, called) = (Bench().hovering(-20), Bench().hovering(-20))
    val answer            = planned.follow(0, planned.north(0.5, 5), planned.north(1.23, -3, lastsS = 1))
    assertEquals(planned.result(answer), Some(true))
    called.pass(0.5)
    called.velocityZ(5, 0, -20, 1)
    called.pass(0.73)
    called.velocityZ(-3, 0, -20, 1)
    planned.pass(1.23)
    assert((planned.position() - called.position()).norm < 1e-5)
    planned.pass(0.7)
    called.pass(0.7)
    assert((planned.position() - called.position()).norm < 0.01)

  test("plans may arrive in any order, and several times"):
    def flown(sequences: Long*) =
      val bench = Bench().hovering(-20)
      for sequence <- sequences do
        bench.follow(sequence, Seq(0.1, 0.3, 0.6).map(bench.north(_, (sequence + 1) * 2.0))*): Unit
      bench.pass(1)
      bench.position()
    assertEquals(flown(1, 0, 0, 1), flown(1))
    assertEquals(flown(0, 1, 0), flown(1))
    assertNotEquals(flown(0), flown(1))

  test("after a plan's end its last action continues for its duration, then the vehicle holds its position"):
    val bench = Bench().hovering(-20)
    bench.follow(0, bench.north(0, 5), bench.north(0.1, 6, lastsS = 1)): Unit
    bench.pass(1.1)
    assert(clue(bench.northMps) > 1)
    bench.pass(15)
    assert(math.abs(bench.northMps) < 0.1, s"${bench.northMps} m/s")

  test("a plan that arrives after its end does not move the vehicle"):
    val bench = Bench().hovering(-20)
    bench.pass(5)
    bench.follow(0, bench.north(0, 5), bench.north(0.1, 6, lastsS = 1)): Unit
    bench.pass(1)
    assert(math.abs(bench.position().x) < 0.2, bench.position().toString)

  test("a move replaces a plan, a plan replaces a move, and a hover ends both"):
    val bench = Bench().hovering(-20)
    val move  = bench.velocityZ(5, 0, -20, 10)
    bench.pass(0.5)
    bench.follow(7, bench.north(0.5, -5, lastsS = 9)): Unit
    assertEquals(bench.result(move), Some(false))
    bench.pass(3)
    assert(clue(bench.northMps) < -2)
    val other = bench.velocityZ(5, 0, -20, 10)
    bench.pass(3)
    assert(clue(bench.northMps) > 2)
    assertEquals(bench.result(other), None)
    bench.tell("hover", Str("Evader"))
    bench.pass(15)
    assert(math.abs(bench.northMps) < 0.1, s"${bench.northMps} m/s")

  test("after a hover older plans have no effect, and a move or a new placement restarts the numbering"):
    val bench = Bench().hovering(-20)
    bench.follow(7, bench.north(0, 5, lastsS = 9)): Unit
    bench.tell("hover", Str("Evader"))
    bench.follow(6, bench.north(0, 5, lastsS = 9)): Unit
    bench.pass(3)
    assert(clue(bench.northMps) < 0.5)
    bench.hovering(-20): Unit
    bench.follow(0, bench.north(bench.elapsedS, 5)): Unit
    bench.pass(0.9)
    assert(clue(bench.northMps) > 0.5)

  test("another controller, which begins with a move, restarts the numbering"):
    val bench = Bench().hovering(-20)
    bench.follow(7, bench.north(0, 5, lastsS = 9)): Unit
    bench.tell("hover", Str("Evader"))
    bench.velocityZ(0, 0, -20, 1): Unit
    bench.follow(0, bench.north(bench.elapsedS, 5, lastsS = 20)): Unit
    bench.pass(3)
    assert(clue(bench.northMps) > 2)

  test("an empty plan is accepted and changes nothing"):
    val bench = Bench().hovering(-20)
    val move  = bench.velocityZ(5, 0, -20, 10)
    assertEquals(bench.result(bench.follow(0)), Some(true))
    bench.pass(1)
    assertEquals(bench.result(move), None)

  test("a plan with functions other than moves, wrong parameters or unordered times is refused"):
    val bench                  = Bench().hovering(-20)
    def refused(actions: Msg*) =
      bench.error("skeinFollowPlan", Int64(0), Arr(actions*), Str("Evader"))
    val none = Seq.empty[Msg]
    assert(clue(refused(Arr(
      Int64(0),
      Str("reset"),
      Arr(none*)
    ))).contains("a function that moves, got 'reset'"))
    assert(clue(refused(Arr(Int64(0), Str("moveByVelocityZ"), Arr(Bool(true))))).contains("wrong parameters"))
    assert(clue(refused(bench.north(1, 5), bench.north(1, 5))).contains("ascending order"))
    assert(
      clue(refused((0 to 16).map(number => bench.north(number, 5))*)).contains("at most 16 actions, got 17")
    )
    assert(clue(refused(Arr(
      Int64(0),
      Str("hover")
    ))).contains("a moment, a function's name and its parameters"))
    assert(clue(bench.error("skeinFollowPlan", Int64(0), Arr(none*), Str("Nobody"))).contains("Nobody"))
