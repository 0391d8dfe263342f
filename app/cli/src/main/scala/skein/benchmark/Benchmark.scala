package skein.benchmark

import scala.collection.mutable
import skein.flight.{NotFlown, VirtualFlights}
import skein.loop.FlightOutcome
import skein.measure.FlightSummary
import skein.scenario.Scenarios
import skein.settings.FlySettings

/** Flies a [[BenchmarkSet]] in virtual time, on all cores: equal sets and seeds give equal bits on every
  * machine.
  */
final class Benchmark(set: BenchmarkSet, seeds: Int)(using Scenarios):

  /** Number of flights. The truth flies once in each task and world, since it meets no link. */
  val flights: Int = seeds * (set.cells.size * set.entries.size + set.tasks.size * set.worlds.size)

  /** Flies all.
    *
    * @param onLanded called after each group of flights with their number
    * @return Left states a mistake in the set
    */
  def fly(onLanded: Int => Unit = _ => ()): Either[String, Vector[BenchmarkRow]] =
    val known = mutable.Map.empty[(String, String), (Vector[BenchmarkFlight], Vector[String])]
    def truth(cell: BenchmarkSet.Cell) = known.get((cell.task.name, cell.world.name)) match
      case Some(flown) => Right(flown)
      case None        =>
        for flown <- flights(cell, None, onLanded)
        yield
          known((cell.task.name, cell.world.name)) = flown
          flown
    (for cell <- set.cells; entry <- set.entries yield (cell, entry))
      .foldLeft[Either[String, Vector[BenchmarkRow]]](Right(Vector.empty)):
        case (before, (cell, entry)) =>
          for
            rows              <- before
            (truths, missing) <- truth(cell)
            (flown, lost)     <- flights(cell, Some(entry), onLanded)
          yield rows :+ BenchmarkRow(cell, entry, truths, flown, missing ++ lost)

  private def flights(
      cell: BenchmarkSet.Cell,
      entry: Option[BenchmarkSet.Entry],
      onLanded: Int => Unit
  ): Either[String, (Vector[BenchmarkFlight], Vector[String])] =
    for settings <- cell.settings(entry, Benchmark.Seed)
    yield
      val (lost, landed) = flown(settings).partitionMap(identity)
      onLanded(seeds)
      (landed, lost.map(_.message))

  private def flown(settings: FlySettings): Vector[Either[NotFlown, BenchmarkFlight]] =
    val plan  = settings.plans.head
    val plans = Vector.tabulate(seeds)(number => plan.copy(seed = settings.seed + number))
    VirtualFlights
      .inParallel(settings, plans): flight =>
        flight.landed.outcome match
          case FlightOutcome.Failed(reason) => Left(NotFlown(flight.landed.plan, reason))
          case _ => Right(BenchmarkFlight.of(FlightSummary.of(flight.recorder.recording)))
      .map(_.flatten)

object Benchmark:
  private val Seed = 1L
