package skein.training

import skein.plot.*

/** How good policies became with the steps they were learned in: means over the episodes of judging, and a
  * standard deviation to either side.
  */
object LearningCurve:

  /** @param scores with what tells them from others in the legend, and their colour
    * @param levels values to compare with, by name
    */
  def apply(
      title: String,
      value: String,
      scores: Seq[(String, Colour, Vector[LearnScore])],
      levels: Seq[(String, Colour, Double)]
  ): Drawing =
    val all   = scores.flatMap(_._3)
    val panel = Panel(
      PlotAxis.around("steps of all environments, thousand", 0, all.map(_.steps / 1e3).max),
      PlotAxis.around(value, 0, (all.map(score => score.mean + score.sd) ++ levels.map(_._3)).max),
      left = 62,
      top = 52,
      width = 560,
      height = 300
    )
    def point(score: LearnScore, off: Double) =
      panel.at(score.steps / 1e3, (score.mean + off * score.sd).max(0))
    val bands = scores.map: (_, colour, curve) =>
      val outline = curve.map(point(_, 1)) ++ curve.reverse.map(point(_, -1))
      Mark.Path(outline, None, Some(colour.faded(0.2)), closed = true)
    val curves = scores.map: (_, colour, curve) =>
      curve match
        // A line would have no length.
        case Vector(one) => Mark.Disc(point(one, 0), 4, None, Some(colour))
        case several => panel.curve(several.map(score => (score.steps / 1e3, score.mean)), Stroke(colour, 2))
    def dashed(colour: Colour) = Stroke(colour, 1.6, Vector(5, 3))
    val lines                  = levels.map: (_, colour, level) =>
      Mark.line(Point(panel.left, panel.atY(level)), Point(panel.right, panel.atY(level)), dashed(colour))
    val legend = Legend(
      panel.left,
      (scores.map((name, colour, _) => Legend.line(name, Stroke(colour, 2))) ++
        levels.map((name, colour, _) => Legend.line(name, dashed(colour))))*
    )
    Drawing(
      panel.right + 40,
      panel.bottom + 44,
      (panel.title(title).moved(
        0,
        -22
      ) +: legend.shapes.map(_.moved(0, 22))) ++ panel.axes ++ bands ++ lines ++ curves
    )

  val learned: Colour = Colour(0x0072b2)
  val other: Colour   = Colour(0xd55e00)
  val paper: Colour   = Colour(0x111111)
