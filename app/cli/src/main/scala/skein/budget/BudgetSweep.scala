package skein.budget

import scala.annotation.tailrec
import skein.lanes.Engine
import skein.optimise.{LatencyBudget, RunningStats}
import skein.signal.LatencyDistribution

/** Flies something over links of many latencies and jitters, and once over none while the world waits.
  *
  * @param asked episodes of each cell, where they were asked for
  */
final class BudgetSweep(subject: BudgetSubject, axes: BudgetAxes, tolerance: Tolerance, asked: Option[Int]):
  /** Of the map's cells, row by row. */
  private val links: Vector[Vector[Option[LatencyDistribution]]] =
    axes.jittersMs.map(jitter => axes.meansMs.map(LatencyBudget.link(_, jitter)))

  private val known = links.flatten.flatten

  /** Of each cell: as many as were asked for, or as are flown in seconds. */
  lazy val episodes: Int = asked.getOrElse(subject.cellEpisodes(known))

  /** What flies the cells. */
  def engine: Engine = subject.engine(known)

  /** Over a link with these round trips. */
  def over(roundTrip: LatencyDistribution): Either[String, RunningStats] =
    subject.tallies(BudgetCells(Vector(roundTrip), episodes)).map(_.head)

  /** The whole map, row by row.
    *
    * @param onProgress told how many episodes are flown
    * @param onRow told of all rows that are known, after each
    * @return of a map that was cancelled those rows; or why there are none
    */
  def map(
      onProgress: Long => Unit,
      isCancelled: () => Boolean,
      onRow: BudgetSweep.Rows => Unit = _ => ()
  ): Either[String, LatencyBudget] =
    for
      truth <- subject.truth
      per   <- tolerance.per(truth).left.map(mistake => s"${subject.formula}: $mistake")
      rows  <- rowsFrom(Vector.empty, onProgress, isCancelled, onRow)
    yield LatencyBudget(axes.meansMs, axes.jittersMs.take(rows.size), rows, truth, per)

  @tailrec private def rowsFrom(
      above: BudgetSweep.Rows,
      onProgress: Long => Unit,
      isCancelled: () => Boolean,
      onRow: BudgetSweep.Rows => Unit
  ): Either[String, BudgetSweep.Rows] =
    val rows = links.slice(above.size, (above.size.toLong + subject.rowsTogether).min(links.size).toInt)
    if rows.isEmpty then Right(above)
    else
      val flown = above.flatten.flatten.size.toLong * episodes
      val cells =
        BudgetCells(rows.flatten.flatten, episodes, done => onProgress(flown + done), isCancelled)
      subject.tallies(cells) match
        case Left(BudgetSubject.Stopped) if above.nonEmpty => Right(above)
        case Left(reason)                                  => Left(reason)
        case Right(tallies)                                =>
          val next  = tallies.iterator
          val known = above ++ rows.map(_.map(_.map(_ => next.next())))
          onRow(known)
          rowsFrom(known, onProgress, isCancelled, onRow)

  /** Episodes of the map. */
  def expected: Long = known.size.toLong * episodes

object BudgetSweep:
  type Rows = Vector[Vector[Option[RunningStats]]]

/** Where the cells lie: round trips' means and jitters, ms, from 0 in even steps. */
final case class BudgetAxes(meansMs: Vector[Double], jittersMs: Vector[Double])

object BudgetAxes:
  /** `count` values each, from 0 up to the most, which is left out. */
  def of(mostMeanMs: Double, means: Int, mostJitterMs: Double, jitters: Int): BudgetAxes =
    BudgetAxes(
      Vector.tabulate(means)(_ * mostMeanMs / means),
      Vector.tabulate(jitters)(_ * mostJitterMs / jitters)
    )
