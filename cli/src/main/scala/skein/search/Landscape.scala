package skein.search

import skein.optimise.{Evaluator, RunningStats}
import skein.policy.SearchSpace

/** The objective around a candidate, along one or two axes of the space with the others at the candidate.
  *
  * @param x number of the axis
  * @param y of the second, if there is one
  * @param cells by y, then by x; one row without y. Rows are missing at the end of a map that is not done
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

  /** One row per cell; a header with the axes' names. */
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
  /** Points along the axis of a curve, and along each of a map. */
  val OnCurve = 61
  val OnMap   = 41

  private val Probes = 9

  /** @param episodes of every cell
    * @param onMap points along each axis of a map
    * @param onRow told of the map after each of its rows
    */
  def of(
      space: SearchSpace,
      best: Vector[Double],
      evaluator: Evaluator,
      episodes: Range,
      onCurve: Int = OnCurve,
      onMap: Int = OnMap,
      onRow: Landscape => Unit = _ => ()
  ): Landscape =
    def values(axis: Int, count: Int) =
      Vector.tabulate(count)(i => space.axes(axis).least + space.axes(axis).width * i / (count - 1))
    if space.dimension == 1 then
      val xs = values(0, onCurve)
      Landscape(space, best, 0, None, xs, Vector(0), Vector(evaluator.tallies(xs.map(Vector(_)), episodes)))
    else
      val Vector(x, y) = mostSensitive(space, best, evaluator, episodes): @unchecked
      val (xs, ys)     = (values(x, onMap), values(y, onMap))
      ys.foldLeft(Landscape(space, best, x, Some(y), xs, ys, Vector.empty)): (below, yValue) =>
        val row  = evaluator.tallies(xs.map(xValue => best.updated(x, xValue).updated(y, yValue)), episodes)
        val land = below.copy(cells = below.cells :+ row)
        onRow(land)
        land

  /** The two axes along which the objective's mean varies most, in the order of the space. */
  private def mostSensitive(
      space: SearchSpace,
      best: Vector[Double],
      evaluator: Evaluator,
      episodes: Range
  ): Vector[Int] =
    val axes   = space.axes.indices.toVector
    val probes = axes.flatMap: axis =>
      Vector.tabulate(Probes): i =>
        best.updated(axis, space.axes(axis).least + space.axes(axis).width * i / (Probes - 1))
    val varied = evaluator.tallies(probes, episodes).map(_.mean).grouped(Probes).map: means =>
      RunningStats.of(means.size)(means).sd
    axes.zip(varied.toVector).sortBy(-_._2).take(2).map(_._1).sorted
