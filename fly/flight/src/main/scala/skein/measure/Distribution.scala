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
  def sd: Double = math.sqrt(squares / count)

  /** Estimated standard deviation of what the samples are drawn from, such as flights with other seeds:
    * divided by one less than their number. 0 for a single one.
    */
  def sampleSd: Double = if count == 1 then 0 else math.sqrt(squares / (count - 1))

  private def squares: Double =
    val centre = mean
    sorted.iterator.map(value => (value - centre) * (value - centre)).sum

  /** The value that the share `p` of the samples does not exceed, on straight lines between samples. */
  def quantile(p: Double): Double =
    val place = p * (count - 1)
    val below = place.toInt
    val above = (below + 1).min(count - 1)
    sorted(below) + (place - below) * (sorted(above) - sorted(below))

object Distribution:
  def of(samples: Iterable[Double]): Option[Distribution] =
    Option.when(samples.nonEmpty)(Distribution(samples.toVector.sorted))
