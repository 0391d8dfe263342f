package skein.benchmark

import skein.measure.{Distribution, FlightSummary}
import skein.optimise.RunningStats

/** The result of one flight.
  *
  * @param headline the value of the scenario's first measure; absent if the flight has none
  * @param ageMs mean age of the deciding vehicle's own reading
  * @param errorsM errors of predictions of the deciding vehicle itself
  */
final case class BenchmarkFlight(
    headline: Option[Double],
    violations: Int,
    ageMs: Option[Double],
    errorsM: Vector[Double]
)

object BenchmarkFlight:
  def of(flown: FlightSummary): BenchmarkFlight = BenchmarkFlight(
    flown.headline,
    flown.result.fold(0)(_.violations.size),
    Distribution.of(flown.roles.flatMap(_.ownTrueAgeMs).map(_.mean)).map(_.mean),
    flown.predictions.fold(Vector.empty)(_.own.samples.map(_._2))
  )

/** The flights of one entry in one cell, and those of the paused loop.
  *
  * @param truths flights by the paused loop, in the cell's world
  * @param notFlown why flights failed
  */
final case class BenchmarkRow(
    cell: BenchmarkSet.Cell,
    entry: BenchmarkSet.Entry,
    truths: Vector[BenchmarkFlight],
    flights: Vector[BenchmarkFlight],
    notFlown: Vector[String]
):
  private def mean(values: Vector[Double]) = Distribution.of(values).map(_.mean)

  private def stats(of: Vector[BenchmarkFlight]) =
    val values = of.flatMap(_.headline)
    RunningStats.of(values.size)(values)

  private val (paused, flown) = (stats(truths), stats(flights))

  val truth: Option[Double] = Option.when(paused.count > 0)(paused.mean)

  /** Deviation of the flights' mean measure from the paused flights' mean, as a fraction of the latter's
    * size.
    */
  val meanOff: Option[Double] =
    truth.filter(_ != 0 && flown.count > 0).map(truth => (flown.mean - truth) / truth.abs)

  /** Half of the 95 % interval of [[meanOff]], by Student's distribution, from the spread of the flights and
    * of the paused flights; absent with fewer than two of either.
    */
  val halfOff: Option[Double] =
    for
      truth <- truth.filter(_ != 0)
      if paused.count > 1 && flown.count > 1
    yield
      val ratio = flown.mean / truth
      math.hypot(flown.halfWidth95, ratio * paused.halfWidth95) / truth.abs

  /** Mean number of violations per flight, less that of the paused flights. */
  val violations: Double =
    def each(of: Vector[BenchmarkFlight]) = mean(of.map(_.violations.toDouble)).getOrElse(0.0)
    each(flights) - each(truths)

  val ageMs: Option[Double] = mean(flights.flatMap(_.ageMs))

  val errorP95M: Option[Double] = Distribution.of(flights.flatMap(_.errorsM)).map(_.quantile(0.95))
