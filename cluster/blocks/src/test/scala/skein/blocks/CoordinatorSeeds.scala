package skein.blocks

import java.nio.file.Files

/** Many small jobs in virtual time, each by one, two and five workers, over a network that loses, doubles,
  * delays and reorders messages: `./sbtw "blocks/Test/runMain skein.blocks.coordinatorSeeds 510"`. Each
  * second a worker dies with probability 1/60, and is cut off with probability 1/30; with every second seed
  * the coordinator dies twice, and loses a part of its ledger. Fails at the first job whose answer differs in
  * a bit from that of one process, or whose ledger does not have every block exactly once.
  */
@main def coordinatorSeeds(seeds: Int): Unit =
  require(seeds > 0, s"expected a number of seeds, got $seeds")
  val blocks = 60
  val alone  = CoordinatorSimulation.alone(blocks)
  val folder = Files.createTempDirectory("seeds")
  try
    for workers <- Seq(1, 2, 5) do
      var (messages, deaths, cuts, restarts) = (0L, 0L, 0L, 0L)
      var (repeated, doubled, lost, overdue) = (0L, 0L, 0L, 0L)
      for seed <- 1L to seeds do
        val diesAt = if seed % 2 == 0 then Seq(2.0 + seed % 3, 6.0 + seed % 4) else Nil
        val flown  = CoordinatorSimulation(seed, workers, blocks, folder)
        try
          flown.fly(deathsAnHour = 60, cutsAnHour = 120, restarts = diesAt)()
          def clue = s"$workers workers, seed $seed"
          require(
            flown.isDone,
            s"$clue: ${flown.done} of $blocks blocks are done, and nothing happens any more"
          )
          require(flown.result == alone, s"$clue: another answer than that of one process")
          require(flown.acceptedTwice == 0, s"$clue: ${flown.acceptedTwice} answers were counted again")
          require(flown.restarts == diesAt.size, s"$clue: the coordinator died ${flown.restarts} times")
        finally flown.close()
        val audit = Ledger.audit(flown.file)
        require(
          audit == Ledger.Audit(blocks, repeats = 0, broken = 0),
          s"$workers workers, seed $seed: $audit"
        )
        Files.delete(flown.file)
        messages += flown.messages
        deaths += flown.deaths
        cuts += flown.cuts
        restarts += flown.restarts
        repeated += flown.counts.repeated
        doubled += flown.counts.doubled
        lost += flown.counts.lost
        overdue += flown.counts.overdue
      println(
        s"$workers workers: $seeds seeds, each the answer of one process to the bit and " +
          s"each of its $blocks blocks in the ledger once; $messages messages, $deaths " +
          s"workers died, $cuts times one was cut off, the coordinator died $restarts " +
          s"times; since its last start $repeated answers came twice, $doubled blocks were " +
          s"given to a second worker, $lost were lost and $overdue overdue"
      )
  finally
    Files.deleteIfExists(folder.resolve(Ledger.Name)): Unit
    Files.delete(folder)
