package skein.blocks

/** What coordinating many workers costs, by simulation:
  * `./sbtw "blocks/Test/runMain skein.blocks.scale 10000 1000000"`.
  *
  * @param workers
  *   speeds are heavy-tailed (Pareto, 1.5); 5 % die in an hour, each is cut off once in four hours
  */
@main def scale(workers: Int, blocks: Int): Unit =
  val begun = System.nanoTime()
  val flown = CoordinatorSimulation(1, workers, blocks, meanSeconds = 60)
  flown.fly(deathsAnHour = 0.05, partitionsAnHour = 0.25, restarts = Nil)
  val right = (0 until blocks).count: number =>
    val work = CoordinatorSimulation.bytes(s"block $number")
    flown.ledger.get(BlockKey.of(work)).contains(CoordinatorSimulation.answer(work))
  val runtime = Runtime.getRuntime
  System.gc()
  println(
    f"$workers%,d workers, $blocks%,d blocks in ${flown.seconds / 3600}%.2f simulated hours; ${flown.deaths} deaths"
  )
  println(s"answers that are right: $right; accepted twice: ${flown.acceptedTwice}; ${flown.counts}")
  println(
    f"messages: ${flown.messages}%,d, ${flown.messages / flown.seconds}%,.0f a second; the coordinator decides ${flown.decidingNanos * 1e-9}%.1f s of processor time, " +
      f"${100 * flown.decidingNanos * 1e-9 / flown.seconds}%.2f %% of a core"
  )
  println(
    f"computing what counts: ${100 * flown.usefulNanos * 1e-9 / flown.seconds / workers}%.1f %% of all workers' time"
  )
  println(
    f"memory of all of it: ${(runtime.totalMemory - runtime.freeMemory) / 1e6}%.0f MB; simulated in ${(System.nanoTime() - begun) * 1e-9}%.0f s"
  )
