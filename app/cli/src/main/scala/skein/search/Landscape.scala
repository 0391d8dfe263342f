package skein.search

import skein.measure.Distribution
import skein.optimise.{Evaluator, RunningStats}
import skein.policy.SearchSpace

/** The objective around a candidate, along one or two axes of the space, with the other parameters at the
  * candidate's values.
  *
  * @param x index of the axis
  * @param y index of the second axis, if there is one
  * @param cells statistics by y, then by x; one row without y. An unfinished map lacks rows at the end
  */
final case class Landscape(
    space: SearchSpace,
    best: Vector[Double],
    x: Int,
    y: Option[Int],
    xs: Vector[Double],
    ys: Vector[Double],
    cells: Vector[Vector[RunningStats]]
):

  /** The median of the cells' standard errors: a bound on how much means differ merely by chance. If episodes
    * share random numbers, they differ less.
    */
  def standardError: Double =
    Distribution.of(cells.flatten.map(tally => tally.sd / math.sqrt(tally.count)).filter(_.isFinite))
      .fold(0.0)(_.median)

  /** The CSV table: a header with the axes' names, and a row per cell. */
  def csv: String =
    val header = (Vector(space.axes(x).name) ++ y.map(space.axes(_).name) ++ Vector(
      "mean",
      "sd",
      "episodes"
    )).mkString(",")
    val rows =
      for
        (row, i)   <- cells.zipWithIndex
        (tally, j) <- row.zipWithIndex
      yield (Vector(xs(j)) ++ y.map(_ => ys(i)) ++ Vector(tally.mean, tally.sd, tally.count)).mkString(",")
    (header +: rows).mkString("", "\n", "\n")

object Landscape:
  /** Number of points along the axis of a curve, and along each axis of a map. */
  val OnCurve = 61
  val OnMap   = 41

  private val Probes = 9

  /** @param episodes the episodes of every cell
    * @param isStopped checked from time to time, from any thread
    * @param onMap number of points along each axis of a map
    * @param onRow called with the map after each of its rows
    * @return None if it was stopped
    */
  def of(
      space: SearchSpace,
      best: Vector[Double],
      evaluator: Evaluator,
      episodes: Range,
      isStopped: () => Boolean,
      onCurve: Int = OnCurve,
      onMap: Int = OnMap,
      onRow: Landscape => Unit = _ => ()
  ): Option[Landscape] =
    def tallies(candidates: Vector[Vector[Double]]) =
      evaluator.talliesUnless(isStopped)(candidates, episodes)
    def values(axis: Int, count: Int) =
      Vector.tabulate(count)(i => space.axes(axis).least + space.axes(axis).width * i / (count - 1))
    if space.dimension == 1 then
      val xs = values(0, onCurve)
      tallies(xs.map(Vector(_))).map(row => Landscape(space, best, 0, None, xs, Vector(0), Vector(row)))
    else
      mostSensitive(space, best)(tallies).flatMap: (x, y) =>
        val (xs, ys) = (values(x, onMap), values(y, onMap))
        val empty    = Landscape(space, best, x, Some(y), xs, ys, Vector.empty)
        ys.foldLeft(Option(empty)): (below, yValue) =>
          for
            below <- below
            row   <- tallies(xs.map(xValue => best.updated(x, xValue).updated(y, yValue)))
          yield
            val land = below.copy(cells = below.cells :+ row)
            onRow(land)
            land

  /** The two axes along which the objective's mean varies most, in the order of the space. */
  private def mostSensitive(space: SearchSpace, best: Vector[Double])(
      tallies: Vector[Vector[Double]] => Option[Vector[RunningStats]]
  ): Option[(Int, Int)] =
    val axes   = space.axes.indices.toVector
    val probes = axes.flatMap: axis =>
      Vector.tabulate(Probes): i =>
        best.updated(axis, space.axes(axis).least + space.axes(axis).width * i / (Probes - 1))
    tallies(probes).map: told =>
      val varied    = told.map(_.mean).grouped(Probes).map(means => RunningStats.of(means.size)(means).sd)
      val Seq(x, y) = axes.zip(varied.toVector).sortBy(-_._2).take(2).map(_._1).sorted: @unchecked
      (x, y)
