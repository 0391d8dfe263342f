package skein.plot

/** Values on a grid of points, each shown as a rectangle that extends halfway to its neighbours.
  *
  * @param xs ascending, at least two
  * @param ys ascending, at least two
  * @param values the values by y, then by x; missing ones stay empty
  */
final case class HeatMap(xs: Vector[Double], ys: Vector[Double], values: Vector[Vector[Option[Double]]]):
  require(
    xs.sizeIs >= 2 && ys.sizeIs >= 2,
    s"a map needs two values on each axis, got ${xs.size} and ${ys.size}"
  )

  /** The rectangles, cut to the panel. */
  def cells(panel: Panel, scale: ColourScale): Vector[Mark] =
    for
      (row, i) <- values.zipWithIndex
      case (Some(value), j) <- row.zipWithIndex
    yield
      // Neighbours overlap by half a pixel: if they only touched, the white below would shine through.
      Mark.box(
        panel.atX(edge(xs, j)).max(panel.left),
        panel.atY(edge(ys, i + 1)).max(panel.top),
        (panel.atX(edge(xs, j + 1)) + 0.5).min(panel.right),
        (panel.atY(edge(ys, i)) + 0.5).min(panel.bottom),
        scale.of(value)
      )

  private def edge(values: Vector[Double], index: Int): Double =
    if index == 0 then values(0) - (values(1) - values(0)) / 2
    else if index == values.size then values.last + (values.last - values(values.size - 2)) / 2
    else (values(index - 1) + values(index)) / 2

  /** The contour of a level: straight pieces between points of the grid (marching squares); no piece next to
    * a missing value.
    */
  def contour(level: Double): Vector[((Double, Double), (Double, Double))] =
    for
      i      <- (0 until ys.size - 1).toVector
      j      <- 0 until xs.size - 1
      around <- corners(i, j).toVector
      piece  <- pieces(around, level)
    yield piece

  private type Corner = (Double, Double, Double)

  /** A square's corners in cyclic order, if all have values. */
  private def corners(i: Int, j: Int): Option[Vector[Corner]] =
    val found = Vector((i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)).flatMap: (row, column) =>
      values(row)(column).map(value => (xs(column), ys(row), value))
    Option.when(found.size == 4)(found)

  private def pieces(square: Vector[Corner], level: Double): Vector[((Double, Double), (Double, Double))] =
    val crossings = (0 until 4).toVector.flatMap: side =>
      val ((x0, y0, v0), (x1, y1, v1)) = (square(side), square((side + 1) % 4))
      Option.when((v0 > level) != (v1 > level)):
        val share = (level - v0) / (v1 - v0)
        (x0 + (x1 - x0) * share, y0 + (y1 - y0) * share)
    crossings match
      case Vector(a, b)       => Vector((a, b))
      case Vector(a, b, c, d) => Vector((a, b), (c, d))
      case _                  => Vector.empty
