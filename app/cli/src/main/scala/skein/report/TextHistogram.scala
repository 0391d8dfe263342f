package skein.report

import skein.measure.Distribution
import skein.plot.PlotAxis

/** A histogram in monospaced text, one line per bin. */
object TextHistogram:
  private val widest = 50

  /** @param unit the samples' unit, for the bins' labels */
  def apply(samples: Distribution, unit: String): String =
    val axis   = PlotAxis.around(unit, samples.least, samples.most, ticks = 16)
    val bins   = axis.ticks.zip(axis.ticks.drop(1))
    val counts = bins.map: (from, to) =>
      samples.sorted.count(value => value >= from && (value < to || to == axis.to && value == to))
    val names = bins.map((from, to) => s"${axis.text(from)} … ${axis.text(to)} $unit")
    val width = names.map(_.length).max
    names
      .zip(counts)
      .map: (name, count) =>
        val bar = "█" * math.ceil(count * widest / counts.max.toDouble).toInt
        s"${" " * (width - name.length)}$name  $bar $count"
      .mkString("\n")
