package skein.budget

import scala.annotation.tailrec
import skein.lanes.Engine
import skein.optimise.{LatencyBudget, RunningStats}
import skein.signal.LatencyDistribution

/** Simulates a subject over links of many latencies and jitters, and once without a link in a world that
  * stands still while the controller decides.
  *
  * @param asked number of episodes for each cell, if the user chose one
  */
final class BudgetSweep(subject: BudgetSubject, axes: BudgetAxes, tolerance: Tolerance, asked: Option[Int]):
  /** Links of the map's cells, row by row; None for impossible cells. */
  private val links: Vector[Vector[Option[LatencyDistribution]]] =
    axes.jittersMs.map(jitter => axes.meansMs.map(LatencyBudget.link(_, jitter)))

  private val known = links.flatten.flatten

  /** Number of episodes for each cell: the user's, or as many as are simulated within seconds. */
  lazy val episodes: Int = asked.getOrElse(subject.cellEpisodes(known))

  def engine: Engine = subject.engine(known)

  /** The subject's statistics over a link with these round trips. */
  def over(roundTrip: LatencyDistribution): Either[String, RunningStats] =
    subject.tallies(BudgetCells(Vector(roundTrip), episodes)).map(_.head)

  /** Simulates the whole map, row by row.
    *
    * @param onProgress called with the number of episodes done
    * @return the rows known, also of a cancelled map; Left says why there are none
    */
  def map(onProgress: Long => Unit, isCancelled: () => Boolean): Either[String, LatencyBudget] =
    for
      truth <- subject.truth(episodes)
      per   <- tolerance.per(truth).left.map(mistake => s"${subject.task.formula}: $mistake")
      rows  <- rowsFrom(Vector.empty, onProgress, isCancelled)
    yield LatencyBudget(axes.meansMs, axes.jittersMs.take(rows.size), rows, truth, per)

  @tailrec private def rowsFrom(
      above: BudgetSweep.Rows,
      onProgress: Long => Unit,
      isCancelled: () => Boolean
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
          val next = tallies.iterator
          rowsFrom(above ++ rows.map(_.map(_.map(_ => next.next()))), onProgress, isCancelled)

  /** Number of episodes that the whole map takes. */
  def expected: Long = known.size.toLong * episodes

object BudgetSweep:
  type Rows = Vector[Vector[Option[RunningStats]]]

/** The map's axes: means and jitters of round trips, ms, from 0 in even steps. */
final case class BudgetAxes(meansMs: Vector[Double], jittersMs: Vector[Double])

object BudgetAxes:
  /** `count` values each, from 0 up to the greatest, which is excluded. */
  def of(mostMeanMs: Double, means: Int, mostJitterMs: Double, jitters: Int): BudgetAxes =
    BudgetAxes(
      Vector.tabulate(means)(_ * mostMeanMs / means),
      Vector.tabulate(jitters)(_ * mostJitterMs / jitters)
    )
