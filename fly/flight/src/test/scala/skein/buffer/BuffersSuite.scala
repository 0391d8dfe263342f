package skein.buffer

import java.util.SplittableRandom
import skein.buffer.Buffers.Verdict
import skein.port.PlanBuffer
import skein.simulator.{PlanCall, PlannedMove}
import skein.units.*
import upack.{Bool, Float32}

class BuffersSuite extends munit.FunSuite:
  import BuffersBench.*

  private def atMs(instant: Instant) = instant.since(Start).toMillis

  private val accepted = Verdict.Answer(Right(Bool(true)))

  /** Speeds and times of the moves that the simulator received. */
  private def flown(bench: BuffersBench): Vector[(Double, Double)] =
    bench.performed.toVector.map(one => (speedOf(one.move), atMs(one.simulated)))

  private def speedOf(move: PlannedMove): Double = move.params.headOption match
    case Some(Float32(mps)) => mps.toDouble
    case _                  => 0

  test(
    "a plan is answered after the first reading, and its moves reach the simulator half a round trip late"
  ):
    val bench = BuffersBench()
    bench.plan(1, 100, 200, 300)
    bench.pass(500)
    assertEquals(bench.verdicts(1_000_001)._1, accepted)
    assertEqualsDouble(bench.verdicts(1_000_001)._2.since(bench.now).toMillis, -499.6, 1e-6)
    val times = bench.performed.map(one => atMs(one.simulated))
    assertEquals(times.size, 3)
    for (time, wanted) <- times.zip(Seq(100, 200, 300)) do assertEqualsDouble(time, wanted + 0.2, 0.01)
    assertEquals(bench.buffers.counts.moves, 3L)
    assert(bench.buffers.counts.latest <= Span.ofMillis(0.01), bench.buffers.counts.toString)

  for speed <- Seq(1.0, 0.25, 5) do
    test(
      s"for plans at random times, moves are those of a buffer in the simulator; clock $speed times as fast"
    ):
      for seed <- 1L to 20 do
        val random = SplittableRandom(seed)
        val bench  = BuffersBench(speed = speed)
        // The moves of a buffer in the simulator, on the simulator's clock.
        var own                       = PlanBuffer.empty[PlannedMove]
        var changes                   = Vector.empty[(Instant, PlannedMove)]
        var arrived                   = Vector.empty[Instant]
        def change(at: Instant): Unit = for due <- own.due(at) do
          if !changes.lastOption.exists(_._2 eq due.action) then changes :+= ((at, due.action))
        def until(at: Instant): Unit =
          Vector.unfold(changes.lastOption.fold(Start)(_._1))(last =>
            own.nextAfter(last).filter(_ <= at).map(next => (next, next))
          ).foreach(change)
        // Lets the buffer learn the clock's rate.
        bench.plan(0, 1e7)
        bench.pass(300)
        for sequence <- 1L to 40 do
          bench.pass(20 + random.nextInt(130) + random.nextDouble())
          if random.nextInt(4) > 0 then
            val first = atMs(bench.simulated) + (random.nextInt(400) - 100) * speed
            val times = (0 until 16).map(first + _ * 100 * speed)
            val moves = times.map(time => north(time, sequence.toDouble)).toVector
            val at    = bench.simulated
            arrived :+= at
            until(at)
            own = own.received(sequence, moves.map(move => (at = move.at, action = move)), at)
            change(at)
            bench.come(sequence, Wish.Plan(Right(PlanCall(sequence, moves, "Drone"))))
        bench.pass(3000)
        until(bench.simulated)
        assert(bench.mostUnanswered <= 2, s"seed $seed")
        val within =
          (0.2 + 1.5) * speed.max(1) // half a round trip; the previous one's answer, and its handover
        val lasted = changes.zip(changes.drop(1).map(_._1) :+ bench.simulated)
        for ((at, move), end) <- lasted if end.since(at).toMillis > 2 * within do
          val done = bench.performed.find(one => one.move.at == move.at && speedOf(one.move) == speedOf(move))
          val late = done.map(_.simulated.since(at).toMillis)
          assert(
            late.exists(ms => ms >= -0.2 * speed.max(1) && ms <= within),
            s"seed $seed: $late ms, at ${atMs(at)}"
          )
        for one <- bench.performed do
          // If a plan arrives exactly at the time of an action, the two clocks may order them differently.
          val isDue  = changes.exists(_._2.at == one.move.at)
          val isEven = arrived.exists: at =>
            val since = at.since(one.move.at).toMillis
            Seq(0, 100 * speed).exists(step => math.abs(since - step) <= 0.5 * speed)
          assert(isDue || isEven, s"seed $seed: ${atMs(one.move.at)} was never due")

  test("no move is repeated when the estimated clock goes back a little"):
    val now                = Instant.Epoch + Span.ofSeconds(9)
    val moves              = Vector(north(100, 1), north(200, 2))
    val plan               = VehicleBuffer().received(1, moves, Start)
    def at(timeMs: Double) = Start + Span.ofMillis(timeMs)
    val first              = plan.sent(plan.next(at(101), now).get, now).ended(now)
    val second             = first.sent(first.next(at(200), now + Span.ofMillis(1)).get, now).ended(now)
    assertEquals(second.next(at(199.5), now + Span.ofMillis(2)), None)
    assertEquals(second.wakeAt(None, maySend = true, now), None)
    // A newer plan replaces the sent moves, from an earlier time on.
    val newer = second.received(2, Vector(north(150, 3)), at(199.5))
    assertEquals(newer.next(at(199.5), now + Span.ofMillis(2)).map(_.move), Some(north(150, 3)))

  test("a move that begins late ends at its own time"):
    val bench = BuffersBench()
    bench.pass(150)
    bench.plan(1, 100)
    bench.pass(10)
    bench.performed.head.move.params(3) match
      case Float32(seconds) => assertEqualsDouble(seconds.toDouble, 9.9496, 1e-4)
      case other            => fail(other.toString)

  test("a plan that arrives after its end lets the vehicle hover"):
    val bench = BuffersBench()
    bench.pass(10_500)
    bench.plan(1, 100)
    bench.pass(10)
    assertEquals(bench.performed.map(_.move.method).toVector, Vector("hover"))

  test("while the simulator stands still no move is performed; afterwards each move continues at its moment"):
    val bench = BuffersBench()
    bench.plan(1, 100, 150, 200)
    bench.pass(120)
    bench.pause()
    bench.pass(2000)
    assertEquals(flown(bench).size, 1)
    bench.resume()
    bench.pass(200)
    val times = flown(bench).map(_._2)
    assertEquals(times.size, 3)
    assertEqualsDouble(times(1), 150, 0.5)
    assertEqualsDouble(times(2), 200, 0.5)

  test(
    "a move due when the clock stops is at most 20 ms early, and one due when it starts at most 20 ms late"
  ):
    for ms <- 100 to 130 do
      val bench = BuffersBench()
      bench.plan(1, ms)
      bench.pass(101)
      bench.pause()
      bench.pass(1000)
      bench.resume()
      bench.pass(100)
      assertEqualsDouble(flown(bench).head._2, ms, 20)

  test("a simulator that does not answer readings receives no moves"):
    val bench = BuffersBench()
    bench.plan(1, 400)
    bench.pass(50)
    bench.answers = false
    bench.pass(600)
    assertEquals(flown(bench), Vector.empty)

  test("a client's move ends the plans and resets their numbers; a client's hover also disables older plans"):
    val bench = BuffersBench()
    bench.plan(7, 100, 200, 300)
    bench.pass(150)
    bench.come(1, Wish.Move("Drone"))
    bench.pass(500)
    assertEquals(flown(bench).map(_._1), Vector(7.0))
    bench.plan(0, 700)
    bench.pass(200)
    assertEquals(flown(bench).map(_._1), Vector(7.0, 0.0))
    bench.plan(5, 900, 1000)
    bench.pass(1)
    bench.come(2, Wish.Hover(""))
    bench.plan(4, 950)
    bench.pass(500)
    assertEquals(flown(bench).map(_._1), Vector(7.0, 0.0))
    assertEquals(bench.verdicts(1_000_004)._1, accepted)
    assertEquals(bench.buffers.counts.stalePlans, 1L)
    bench.plan(6, 1500)
    bench.pass(500)
    assertEquals(flown(bench).map(_._1), Vector(7.0, 0.0, 6.0))

  test("a reset, a cancelled task or a new pose ends a vehicle's plans; plans of other vehicles continue"):
    for wish <- Seq(Wish.Reset, Wish.Stop("Drone"), Wish.Place("Drone")) do
      val bench = BuffersBench()
      bench.plan(7, 100, 200)
      bench.pass(50)
      bench.come(1, wish)
      bench.pass(500)
      assertEquals((wish, flown(bench)), (wish, Vector.empty))
    val bench = BuffersBench()
    bench.plan(7, 100, 200)
    for wish <- Seq(Wish.Move("Other"), Wish.Stop("Other"), Wish.Hover("Other")) do bench.come(1, wish)
    bench.pass(500)
    assertEquals(flown(bench).size, 2)

  test("a client's move passes without delay, but waits if two moves of the buffer are unanswered"):
    val bench = BuffersBench(roundTrip = Span.ofMillis(10))
    bench.plan(7, 100, 200)
    bench.pass(150)
    val early = bench.now
    bench.come(1, Wish.Move("Drone"))
    assertEquals(bench.verdicts(1), (Verdict.Pass(Some("Drone")), early))
    bench.pass(100)
    bench.plan(8, 300, 303)
    bench.pass(55) // the first is on its way, the client's move not answered
    val asked = bench.now
    bench.come(2, Wish.Move("Drone"))
    assertEquals(bench.verdicts.get(2), None)
    bench.pass(100)
    val waited = bench.verdicts(2)._2.since(asked).toMillis
    assert(waited > 1 && waited < 15, s"$waited ms")
    assertEquals(bench.mostUnanswered, 2)
    assertEquals(bench.buffers.counts.heldCalls, 1L)

  test("a reset waits until one of two unanswered moves is answered"):
    val bench = BuffersBench(roundTrip = Span.ofMillis(10))
    bench.plan(8, 100, 103)
    bench.pass(105)
    bench.come(2, Wish.Reset)
    assertEquals(bench.verdicts.get(2), None)
    bench.pass(100)
    assertEquals(bench.verdicts(2)._1, Verdict.Pass(None))
    assertEquals(flown(bench).size, 2)

  test("an invalid plan, or one for a missing vehicle, is refused with the reason"):
    val bench = BuffersBench()
    bench.come(1, Wish.Plan(Left("std::bad_cast")))
    assertEquals(bench.verdicts(1)._1, Verdict.Answer(Left("std::bad_cast")))
    bench.come(2, Wish.Plan(Right(PlanCall(0, Vector.empty, "Nobody"))))
    bench.pass(10)
    bench.verdicts(2)._1 match
      case Verdict.Answer(Left(text)) => assert(text.contains("there is no Nobody"), text)
      case other                      => fail(other.toString)
    assertEquals(bench.buffers.counts.refusedPlans, 2L)

  test("an empty plan checks that the vehicle exists, and changes nothing"):
    val bench = BuffersBench()
    bench.plan(1, 100)
    bench.plan(2)
    bench.pass(200)
    assertEquals(bench.verdicts(1_000_002)._1, accepted)
    assertEquals(flown(bench).size, 1)

  test("plans of more vehicles than the limit are refused"):
    val bench = BuffersBench()
    for number <- 0 to Buffers.MostVehicles do
      bench.come(number, Wish.Plan(Right(PlanCall(0, Vector.empty, s"Drone$number"))))
      bench.pass(1)
    assertEquals(bench.verdicts.values.count(_._1 == accepted), Buffers.MostVehicles)
    assertEquals(bench.buffers.counts.refusedPlans, 1L)
