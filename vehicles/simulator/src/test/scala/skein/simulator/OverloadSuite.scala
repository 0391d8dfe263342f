package skein.simulator

import skein.units.*

class OverloadSuite extends munit.FunSuite:

  private def burst(bench: Bench, moves: Int): Seq[Long] =
    for i <- 0 until moves yield bench.velocityZ(1, i * 0.1, -20, 4)

  test("the moves of a burst of three four-second moves end at 0, 4 and 8 s"):
    val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
    val moves = burst(bench, 3)
    bench.pass(20)
    val ends = moves.map(bench.answeredAt(_).get)
    assertEquals(moves.map(bench.result), Seq(Some(false), Some(true), Some(true)))
    ends.zip(Seq(0.0, 4.0, 8.0)).foreach((end, expected) => assertEqualsDouble(end, expected, 0.01))

  test("moves that replace each other one at a time all start immediately"):
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
    test(s"a burst of $moves four-second moves delays a reading for $seconds s, as AirSim's six workers do"):
      val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
      val sent  = burst(bench, moves)
      val read  = bench.call("getMultirotorState", upack.Str(""))
      bench.pass(100)
      assertEqualsDouble(bench.answeredAt(read).get, seconds, 0.02)
      assert(sent.forall(bench.answeredAt(_).nonEmpty))

  test("a burst of twenty moves delays a reading for 20 to 28 s, after any earlier bursts"):
    val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
    for round <- 1 to 20 do
      burst(bench, 8 + round % 5)
      bench.pass(60)
      burst(bench, 20)
      val sent = bench.elapsedS
      val read = bench.call("getMultirotorState", upack.Str(""))
      bench.pass(100)
      val took = bench.answeredAt(read).get - sent
      assert(took > 19.9 && took < 28.1, s"round $round: $took s")

  test("with Overload.Never the newest move replaces the older one immediately and nothing waits"):
    val bench = Bench(overload = Overload.Never).hovering(-20)
    val moves = burst(bench, 20)
    assertEquals(bench.now[Boolean]("ping"), true)
    assertEquals(moves.init.map(bench.result), Vector.fill(19)(Some(false)))
    bench.pass(4.01)
    assertEqualsDouble(bench.answeredAt(moves.last).get, 4, 1e-9)

  test("a move that waits for its lock receives it before physics is stepped"):
    val bench = Bench().hovering(-20)
    bench.tell("simPause", upack.Bool(true))
    bench.velocity(-5, 0, 0, 10)
    bench.continueFor(1)
    bench.velocity(5, 0, 0, 10)
    bench.continueFor(3)
    assert(bench.kinematics().linear_velocity.x_val > 3)

  test("control calls never wait behind moves"):
    val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
    burst(bench, 20): Unit
    val read = bench.call("getMultirotorState", upack.Str(""))
    for (control, params) <- Seq(
        "ping"             -> Nil,
        "getServerVersion" -> Nil,
        "simPause"         -> Seq(upack.Bool(false)),
        "simIsPaused"      -> Nil,
        "cancelLastTask"   -> Seq(upack.Str("Pursuer")),
        "hover"            -> Seq(upack.Str("Pursuer"))
      )
    do assert(bench.isAnswered(bench.call(control, params*)), control)
    assert(!bench.isAnswered(read), "as at AirSim, a reading waits")

  for (control, params) <- Seq("hover" -> Seq(upack.Str("Evader")), "reset" -> Nil) do
    test(s"after a $control no earlier move is run, and nothing waits"):
      val bench = Bench(Seq("Evader", "Pursuer")).hovering(-20)
      val moves = burst(bench, 20)
      val read  = bench.call("getMultirotorState", upack.Str(""))
      bench.call(control, params*): Unit
      assertEquals(moves.map(bench.result), Vector.fill(20)(Some(false)))
      assert(bench.isAnswered(read))

  test("while paused, the newest move replaces the older one immediately, and no call waits"):
    val bench = Bench().hovering(-20)
    bench.tell("simPause", upack.Bool(true))
    val moves = for i <- 1 to 12 yield bench.velocityZ(1, i * 0.1, -5, 1000)
    assertEquals(moves.init.map(bench.result), Vector.fill(11)(Some(false)))
    assert(bench.isAnswered(bench.call("getMultirotorState", upack.Str(""))))
    bench.tell("simPause", upack.Bool(false))
    bench.pass(5)
    assertEqualsFloat(bench.kinematics().linear_velocity.y_val, 1.2f, 0.2f)

  test("a burst of moves of a client that has left holds no worker, and its newest move runs"):
    val bench = Bench().hovering(-20)
    val moves = for i <- 1 to 12 yield bench.velocityZ(1, i * 0.1, -20, 1000, client = 7)
    val read  = bench.callBy(8)("getMultirotorState", upack.Str(""))
    assert(!bench.isAnswered(read))
    bench.depart(7)
    assert(bench.isAnswered(read))
    assert(moves.count(bench.isAnswered) >= 10)
    val own = bench.velocityZ(0, 2, -20, 1, client = 8)
    bench.pass(1.1)
    assertEquals(bench.result(own), Some(true), "nor does another client's move wait behind them")

  test("a client's only move continues after it has left, without a worker"):
    val bench = Bench(overload = Overload.Workers(1)).hovering(-20)
    val move  = bench.velocityZ(3, 0, -20, 2, client = 7)
    val read  = bench.callBy(8)("getMultirotorState", upack.Str(""))
    assert(!bench.isAnswered(read))
    bench.depart(7)
    assert(bench.isAnswered(read))
    bench.pass(2)
    assertEquals(bench.result(move), Some(true))
    // Also for messages after it has left.
    val late = bench.velocityZ(3, 0, -20, 2, client = 7)
    assert(!bench.isAnswered(late))
    assert(bench.isAnswered(bench.callBy(8)("getMultirotorState", upack.Str(""))))

  test("moves may hold all workers for the set time, in total; then no call waits behind them"):
    val bench = Bench(patience = Some(Span.ofSeconds(6))).hovering(-20)
    for _ <- 1 to 2 do
      burst(bench, 12): Unit
      val read = bench.call("getMultirotorState", upack.Str(""))
      bench.pass(60)
      assert(bench.isAnswered(read))
    assert(bench.simulation.hasHeldUp)
    val moves = burst(bench, 12)
    assertEquals(moves.init.map(bench.result), Vector.fill(11)(Some(false)))
    assert(bench.isAnswered(bench.call("getMultirotorState", upack.Str(""))))

  test("moves that replace one another occasionally do not use up that time"):
    val bench = Bench(Seq("A", "B", "C", "D"), patience = Some(Span.ofSeconds(1))).hovering(-20)
    for i <- 1 to 200 do
      for name <- Seq("A", "B", "C", "D") do bench.velocityZ(1, i * 0.01, -20, 10, name): Unit
      bench.pass(0.1)
    assert(!bench.simulation.hasHeldUp)
