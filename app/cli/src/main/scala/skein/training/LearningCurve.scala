package skein.training

import skein.plot.*

/** A plot of the policies' mean objective over the evaluation's episodes against the number of environment
  * steps, with a band of one standard deviation on either side.
  */
object LearningCurve:

  /** @param scores each with its label in the legend and its colour
    * @param levels values to compare with, and their names
    */
  def apply(
      title: String,
      value: String,
      scores: Seq[(String, Colour, Vector[LearnScore])],
      levels: Seq[(String, Colour, Double)]
  ): Drawing =
    val all = scores.flatMap(_._3)
    // What is never negative has no band below 0.
    val isPositive = all.forall(_.mean >= 0)
    val least      =
      if isPositive then levels.map(_._3).minOption.getOrElse(0.0).min(0)
      else (all.map(score => score.mean - score.sd) ++ levels.map(_._3)).min.min(0)
    val panel = Panel(
      PlotAxis.around("steps of all environments, thousand", 0, all.map(_.steps / 1e3).max),
      PlotAxis.around(value, least, (all.map(score => score.mean + score.sd) ++ levels.map(_._3)).max.max(0)),
      left = 62,
      top = 52,
      width = 560,
      height = 300
    )
    def point(score: LearnScore, off: Double) =
      val value = score.mean + off * score.sd
      panel.at(score.steps / 1e3, if isPositive then value.max(0) else value)
    val bands = scores.map: (_, colour, curve) =>
      val outline = curve.map(point(_, 1)) ++ curve.reverse.map(point(_, -1))
      Mark.Path(outline, None, Some(colour.faded(0.2)), closed = true)
    val strokes = (scores.map(_._2) ++ levels.map(_._2)).zipWithIndex
      .map((colour, index) => Stroke(colour, 2).dashed(index))
    val curves = scores.zip(strokes).map:
      // A line would have no length.
      case ((_, colour, Vector(one)), _) => Mark.Disc(point(one, 0), 4, None, Some(colour))
      case ((_, _, several), stroke)     =>
        panel.curve(several.map(score => (score.steps / 1e3, score.mean)), stroke)
    val lines = levels.zip(strokes.drop(scores.size)).map:
      case ((_, _, level), stroke) => panel.level(level, stroke)
    Legend.between(
      panel,
      title,
      panel.axes ++ bands ++ lines ++ curves,
      (scores.map(_._1) ++ levels.map(_._1)).zip(strokes).map(Legend.line(_, _))*
    )

  val learned: Colour = Colour(0x0072b2)
  val other: Colour   = Colour(0xd55e00)
  val paper: Colour   = Colour(0x111111)
