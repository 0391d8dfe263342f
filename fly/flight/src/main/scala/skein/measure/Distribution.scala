package skein.measure

/** Samples of one quantity, at least one, ascending. */
final case class Distribution private (sorted: Vector[Double]):
  def count: Int     = sorted.size
  def least: Double  = sorted.head
  def most: Double   = sorted.last
  def mean: Double   = sorted.sum / count
  def median: Double = quantile(0.5)
  def p99: Double    = quantile(0.99)

  /** Standard deviation of the samples themselves: divided by their number, not by one less. */
  def sd: Double =
    val centre = mean
    math.sqrt(sorted.iterator.map(value => (value - centre) * (value - centre)).sum / count)

  /** The value that the share `p` of the samples does not exceed, on straight lines between samples. */
  def quantile(p: Double): Double =
    val place = p * (count - 1)
    val below = place.toInt
    val above = (below + 1).min(count - 1)
    sorted(below) + (place - below) * (sorted(above) - sorted(below))

object Distribution:
  def of(samples: Iterable[Double]): Option[Distribution] =
    Option.when(samples.nonEmpty)(Distribution(samples.toVector.sorted))
