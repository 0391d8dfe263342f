package skein.benchmark

import skein.flight.VirtualFlights
import skein.scenario.Scenarios
import skein.units.Expect

/** Flies a [[BenchmarkSet]] in virtual time, on all cores: equal sets and seeds give equal bits on every
  * machine.
  */
final class Benchmark(set: BenchmarkSet, seeds: Int)(using Scenarios):

  /** A cell for each task and world, in which the truth flies once. */
  private val truthCells = set.cells.distinctBy(_.ofTruth)

  /** How many flights [[fly]] flies, those of the truth included. */
  val flights: Int = seeds * (set.cells.size * set.entries.size + truthCells.size)

  /** Flies all.
    *
    * @param onLanded called after each group of flights with their number
    * @return Left states a mistake in the set
    */
  def fly(onLanded: Int => Unit = _ => ()): Either[String, Vector[BenchmarkRow]] =
    for
      truths <- Expect.each(truthCells): cell =>
        flown(cell, BenchmarkSet.Truth, onLanded).map(cell.ofTruth -> _)
      truthOf = truths.toMap
      rows <- Expect.each(for cell <- set.cells; entry <- set.entries yield (cell, entry)): (cell, entry) =>
        for (flights, lost) <- flown(cell, entry, onLanded)
        yield
          val (truths, missing) = truthOf(cell.ofTruth)
          BenchmarkRow(cell, entry, truths, flights, missing ++ lost)
    yield rows

  /** The flights of an entry in a cell, and why others failed. */
  private def flown(
      cell: BenchmarkSet.Cell,
      entry: BenchmarkSet.Entry,
      onLanded: Int => Unit
  ): Either[String, (Vector[BenchmarkFlight], Vector[String])] =
    for settings <- cell.settings(entry, Benchmark.Seed)
    yield
      val plan           = settings.plans.head
      val plans          = Vector.tabulate(seeds)(number => plan.copy(seed = settings.seed + number))
      val (lost, landed) =
        VirtualFlights.summaries(settings, plans)(_.map(BenchmarkFlight.of)).partitionMap(identity)
      onLanded(seeds)
      (landed, lost.map(_.message))

object Benchmark:
  private val Seed = 1L
