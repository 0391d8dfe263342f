package skein.blocks

import java.nio.file.Files
import skein.testing.TemporaryFolders

class CoordinatorSuite extends munit.FunSuite, TemporaryFolders:
  import CoordinatorSimulation.bytes

  private def blocks(count: Int) = Vector.tabulate(count)(number => Block(number, bytes(s"work $number")))

  private val two = Coordinator().joined("anna", 2).joined("ben", 2)

  private def take(state: Coordinator, worker: String, nowNanos: Long = 0, holding: Set[Long] = Set.empty) =
    val (next, block) = state.asked(worker, holding, nowNanos)
    (next, block.map(_.number))

  test("blocks are assigned in their order, two to a worker"):
    val (a, first)  = take(two.offered(blocks(3)), "anna")
    val (b, second) = take(a, "anna", holding = Set(0))
    val (c, third)  = take(b, "anna", holding = Set(0, 1))
    val (_, other)  = take(c, "ben")
    assertEquals((first, second, third, other), (Some(0L), Some(1L), None, Some(2L)))

  test("the last blocks are assigned to a second worker, too, the oldest first, and the first answer counts"):
    val (a, _)      = take(two.offered(blocks(2)), "anna", nowNanos = 5)
    val (b, _)      = take(a, "anna", nowNanos = 7, holding = Set(0))
    val (c, again)  = take(b, "ben", nowNanos = 8)
    val (d, first)  = c.answered("ben", 0, 10)
    val (e, second) = d.answered("anna", 0, 10)
    assertEquals(again, Some(0L))
    assertEquals((first, second), (Some(blocks(1).head), None))
    assertEquals(e.counts, Coordinator.Counts(accepted = 1, repeated = 1, doubled = 1, lost = 0, overdue = 0))
    assertEquals((e.workers("ben").accepted, e.workers("anna").repeated), (1L, 1L))

  test("the counted cores are those of present workers, each as it last joined"):
    assertEquals((Coordinator().cores, two.cores), (0, 4))
    assertEquals(two.joined("anna", 7).cores, 9)
    assertEquals(two.lost("ben").cores, 2)
    assertEquals(two.lost("ben").joined("ben", 3).cores, 5)
    assertEquals(two.lost("ben").lost("ben").cores, 2)

  test("waiting blocks are counted, whether they had a worker or not"):
    def waits(state: Coordinator) = (state.waiting.size, state.waiting.isEmpty, state.waiting.nonEmpty)
    assertEquals(waits(two), (0, true, false))
    val (held, _) = take(two.offered(blocks(1)), "anna")
    assertEquals(waits(held), (0, true, false))
    assertEquals(waits(held.lost("anna")), (1, false, true))
    assertEquals(waits(held.lost("anna").offered(blocks(3).drop(1))), (3, false, true))
    assertEquals(waits(two.offered(blocks(2))), (2, false, true))

  test("a worker gets a second block for each core while as many wait as there are cores"):
    def third(waiting: Int) =
      val (a, _) = take(two.offered(blocks(2 + waiting)), "anna")
      val (b, _) = take(a, "anna", holding = Set(0))
      assertEquals((b.cores, b.waiting.size), (4, waiting))
      take(b, "anna", holding = Set(0, 1))._2
    assertEquals((third(waiting = 3), third(waiting = 4)), (None, Some(2L)))

  test("an unknown worker's answer counts, but its cores do not until it joins"):
    val (held, _)       = take(two.offered(blocks(2)), "anna")
    val (first, one)    = held.answered("carl", 0, 10)
    val (again, second) = first.answered("dora", 0, 20)
    assertEquals((one, second), (Some(blocks(1).head), None))
    assertEquals((again.counts.accepted, again.counts.repeated), (1L, 1L))
    for (name, accepted, busy) <- Seq(("carl", 1L, 10L), ("dora", 0L, 20L)) do
      val record = again.workers(name)
      assertEquals(
        (record.cores, record.isHere, record.accepted, record.busyNanos),
        (0, false, accepted, busy)
      )
      assertEquals(record.repeated, 1 - accepted)
      assertEquals(take(again, name)._2, None)
      assertEquals(again.joined(name, 3).cores, 7)

  test("no worker holds a block twice"):
    val (a, _) = take(two.offered(blocks(1)), "anna")
    assertEquals(take(a, "anna", holding = Set(0))._2, None)

  test("a lost worker's blocks wait again ahead of all other blocks, except those that another worker has"):
    val (a, _)    = take(two.offered(blocks(3)), "anna")
    val (b, _)    = take(a, "anna", holding = Set(0))
    val (c, next) = take(b.lost("anna"), "ben")
    assertEquals((next, c.counts.lost), (Some(0L), 2L))
    assertEquals(take(b.lost("anna"), "anna")._2, None, "who is gone gets nothing before joining again")

  test("a block that never reached its worker is assigned again once it can no longer be in transit"):
    val (a, _)     = take(two.offered(blocks(1)), "anna", nowNanos = 0)
    val (b, early) = take(a, "anna", nowNanos = 4_000_000_000L)
    val (_, late)  = take(b, "anna", nowNanos = 4_000_000_001L)
    assertEquals((early, late), (None, Some(0L)))

  test("a block is overdue after the patience, with one worker or with two, and its answer still counts"):
    val start     = Coordinator(patienceNanos = 100).joined("anna", 1).joined("ben", 1).offered(blocks(1))
    val (one, _)  = take(start, "anna", nowNanos = 1000)
    val (both, _) = take(one, "ben", nowNanos = 1050)
    for state <- Seq(one, both) do
      assertEquals(state.at(1100).counts.overdue, 0L)
      val late = state.at(1101)
      assertEquals(
        (late.counts.overdue, late.waiting.iterator.map(_.number).toSeq, late.leases.size),
        (1L, Seq(0L), 0)
      )
      val (done, answer) = late.answered("anna", 0, 1)
      assertEquals(answer, Some(blocks(1).head))
      assertEquals((done.counts.accepted, done.counts.repeated), (1L, 0L))
      val by = done.workers("anna")
      assertEquals((by.accepted, by.repeated, by.busyNanos), (1L, 0L, 1L))
      assert(!start.isIdle && !one.isIdle && !late.isIdle && done.isIdle)

  test("after a cancellation nothing is assigned, and answers that arrive are repeats"):
    val (a, _)    = take(two.offered(blocks(2)), "anna")
    val cancelled = a.cancelled
    assert(cancelled.isIdle)
    assertEquals(cancelled.answered("anna", 0, 1)._2, None)

  /** Runs a simulation to its end, and checks its result and ledger. */
  private def assertRight(flown: CoordinatorSimulation, blocks: Int, clue: String): Unit =
    assert(flown.isDone, s"$clue: not done")
    assertEquals(flown.acceptedTwice, 0, clue)
    assertEquals(flown.result, CoordinatorSimulation.alone(blocks), clue)
    flown.close()
    assertEquals(Ledger.audit(flown.file), Ledger.Audit(blocks, repeats = 0, broken = 0), clue)

  for (deaths, cuts, name) <-
      Seq(
        (0.0, 0.0, "all live"),
        (360.0, 0.0, "one in ten dies each second"),
        (60.0, 120.0, "some die, others are cut off")
      )
  do
    folder.test(
      s"every block counts once, and the answer equals a single process's to the bit: $name"
    ): folder =>
      var restarts = 0
      for seed <- 1L to 12L do
        val flown = CoordinatorSimulation(seed, workers = 5, blocks = 60, folder)
        flown.fly(deaths, cuts, restarts = if seed % 2 == 0 then Seq(10, 25) else Nil)()
        restarts += flown.restarts
        assertRight(flown, 60, s"seed $seed")
        Files.delete(flown.file)
      assert(clue(restarts) > 10)

  folder.test(
    "a thousand workers of heavy-tailed speeds finish, although many die or are cut off together"
  ): folder =>
    val flown = CoordinatorSimulation(1, workers = 1000, blocks = 8_000, folder)
    flown.fly(deathsAnHour = 5, cutsAnHour = 5, restarts = Seq(30), splits = Seq(15, 45))()
    assertRight(flown, 8_000, "a thousand")
    assert(clue(flown.deaths) > 50 && clue(flown.cuts) > 400)
    // No message costs more with more workers and blocks.
    assert(clue(flown.messages) < 40 * 8_000)
