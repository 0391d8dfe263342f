package skein.plot

import skein.units.Decimals.fixed

/** One axis: its label, its range, and its ticks. */
final case class PlotAxis(label: String, from: Double, to: Double, ticks: Vector[Double]):
  require(from < to, s"axis '$label' runs from $from to $to")

  /** A value's position on the axis: 0 at its start, 1 at its end. */
  def share(value: Double): Double = (value - from) / (to - from)

  /** A tick's label, with as many decimals as the ticks' distance needs. */
  def text(tick: Double): String =
    val step     = if ticks.sizeIs > 1 then ticks(1) - ticks(0) else 1
    val decimals = math.ceil(-math.log10(step) - 1e-9).toInt.max(0)
    // Avoids a minus before zero.
    (if math.abs(tick) < step / 1e6 then 0.0 else tick).fixed(decimals)

object PlotAxis:

  /** An axis whose ends are ticks, and that contains all values. */
  def around(label: String, least: Double, most: Double, ticks: Int = 5): PlotAxis =
    val upper = if most > least then most else least + 1
    val step  = niceStep((upper - least) / ticks)
    val from  = math.floor(least / step + 1e-9) * step
    val to    = math.ceil(upper / step - 1e-9) * step
    PlotAxis(label, from, to, ticksBetween(from, to, step))

  def exactly(label: String, from: Double, to: Double, ticks: Int = 5): PlotAxis =
    PlotAxis(label, from, to, ticksBetween(from, to, niceStep((to - from) / ticks)))

  /** An axis of this length, around the middle of the values. */
  def centred(label: String, values: Vector[Double], length: Double): PlotAxis =
    val middle = (values.min + values.max) / 2
    exactly(label, middle - length / 2, middle + length / 2)

  /** The smallest number of the form 1, 2 or 5 × 10^n^ that is not below `atLeast`. */
  private def niceStep(atLeast: Double): Double =
    val power = math.pow(10, math.floor(math.log10(atLeast)))
    Seq(1, 2, 5, 10).map(_ * power).find(_ >= atLeast * (1 - 1e-9)).getOrElse(10 * power)

  private def ticksBetween(from: Double, to: Double, step: Double): Vector[Double] =
    val first = math.ceil(from / step - 1e-9).toLong
    val last  = math.floor(to / step + 1e-9).toLong
    Vector.range(first, last + 1).map(_ * step)
