package skein.simulator

class OverloadSuite extends munit.FunSuite:

  private def burst(bench: Bench, moves: Int): Seq[Long] =
    for i <- 0 until moves yield bench.velocityZ(1, i * 0.1, -20, 4)

  test("a burst of three four-second moves ends at 0, 4 and 8 s"):
    val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
    val moves = burst(bench, 3)
    bench.pass(20)
    val ends = moves.map(bench.answeredAt(_).get)
    assertEquals(moves.map(bench.result), Seq(Some(false), Some(true), Some(true)))
    ends.zip(Seq(0.0, 4.0, 8.0)).foreach((end, expected) => assertEqualsDouble(end, expected, 0.01))

  test("moves that replace each other one at a time all start at once"):
    val bench = Bench().hovering(-20)
    val moves =
      for i <- 1 to 50 yield
        val move = bench.velocityZ(1, i * 0.1, -20, 4)
        bench.pass(0.001)
        move
    assertEquals(moves.init.map(bench.result), Vector.fill(49)(Some(false)))
    bench.pass(4)
    assertEquals(bench.result(moves.last), Some(true))

  for (moves, seconds) <- Seq((5, 0.0), (8, 4.0), (20, 24.0)) do
    test(s"a burst of $moves four-second moves holds a ping up for $seconds s, as at AirSim's six workers"):
      val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
      val sent  = burst(bench, moves)
      val ping  = bench.call("ping")
      bench.pass(100)
      assertEqualsDouble(bench.answeredAt(ping).get, seconds, 0.02)
      assert(sent.forall(bench.answeredAt(_).nonEmpty))

  test("whatever bursts came before, one of twenty holds a ping up for 20 to 28 s"):
    val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
    for round <- 1 to 20 do
      burst(bench, 8 + round % 5)
      bench.pass(60)
      burst(bench, 20)
      val sent = bench.elapsedS
      val ping = bench.call("ping")
      bench.pass(100)
      val took = bench.answeredAt(ping).get - sent
      assert(took > 19.9 && took < 28.1, s"round $round: $took s")

  test("with overload off the newest move wins at once and nothing waits"):
    val bench = Bench(overload = Overload.Never).hovering(-20)
    val moves = burst(bench, 20)
    assertEquals(bench.now[Boolean]("ping"), true)
    assertEquals(moves.init.map(bench.result), Vector.fill(19)(Some(false)))
    bench.pass(4.01)
    assertEqualsDouble(bench.answeredAt(moves.last).get, 4, 1e-9)

  test("a move that waits for its lock has it before physics is stepped"):
    val bench = Bench().hovering(-20)
    bench.tell("simPause", upack.Bool(true))
    bench.velocity(-5, 0, 0, 10)
    bench.continueFor(1)
    bench.velocity(5, 0, 0, 10)
    bench.continueFor(3)
    assert(bench.kinematics().linear_velocity.x_val > 3)
