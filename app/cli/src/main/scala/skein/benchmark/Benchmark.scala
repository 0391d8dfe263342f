package skein.benchmark

import skein.flight.VirtualFlights
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.units.Expect

/** Runs a [[BenchmarkSet]] in virtual time, on all cores: equal sets and seeds give equal bits on every
  * machine.
  */
final class Benchmark(set: BenchmarkSet, seeds: Int)(using Scenarios):

  /** A cell for each task and world, in which the paused loop is simulated once. */
  private val truthCells = set.cells.distinctBy(_.ofTruth)

  private val (refused, planned) =
    (for cell <- set.cells; entry <- set.entries yield (cell, entry)).partitionMap: (cell, entry) =>
      cell
        .settings(entry, Benchmark.Seed)
        .fold(why => Left((cell.task, entry, why)), settings => Right((cell, entry, settings)))

  /** The combinations that cannot run, and why: for example a policy in a task without its role. */
  val notFlown: Vector[String] =
    refused.map((task, entry, why) => s"${entry.name} does not fly ${task.name}: $why").distinct

  /** Why a user's own policy runs in no task and by no loop, if there is such a policy. */
  val mistake: Option[String] = refused.collectFirst:
    case (_, entry, why) if entry.policy.isDefined && !planned.exists(_._2.policy == entry.policy) => why

  /** Number of flights that [[fly]] simulates, including those of the paused loop. */
  val flights: Int = seeds * (planned.size + truthCells.size)

  /** Simulates all flights.
    *
    * @param onLanded called after each group of flights with its size
    * @return Left states a mistake in the set
    */
  def fly(onLanded: Int => Unit = _ => ()): Either[String, Vector[BenchmarkRow]] =
    for
      truths <- Expect.each(truthCells): cell =>
        cell.settings(BenchmarkSet.Truth, Benchmark.Seed).map(cell.ofTruth -> flown(_, onLanded))
      truthOf = truths.toMap
    yield planned.map: (cell, entry, settings) =>
      val (flights, lost)   = flown(settings, onLanded)
      val (truths, missing) = truthOf(cell.ofTruth)
      BenchmarkRow(cell, entry, truths, flights, missing ++ lost)

  /** The flights of an entry in a cell, and why others failed. */
  private def flown(settings: FlySettings, onLanded: Int => Unit): (Vector[BenchmarkFlight], Vector[String]) =
    val plan           = settings.plans.head
    val plans          = Vector.tabulate(seeds)(number => plan.copy(seed = settings.seed + number))
    val (lost, landed) =
      VirtualFlights.summaries(settings, plans)(_.map(BenchmarkFlight.of)).partitionMap(identity)
    onLanded(seeds)
    (landed, lost.map(_.message))

object Benchmark:
  private val Seed = 1L
