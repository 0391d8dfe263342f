package skein.measure

/** Compares the distributions of two samples of one quantity. */
object KolmogorovSmirnov:

  /** The largest difference between the shares of samples up to a value, over all values: 0 for equal
    * samples, 1 for samples that do not overlap (Smirnov, 1948).
    *
    * @param within tolerance of values: the fraction of one sample up to a value is compared with the
    *   fraction of the other up to the value plus this
    */
  def distance(one: Distribution, other: Distribution, within: Double = 0): Double =
    ahead(one, other, within).max(ahead(other, one, within))

  private def ahead(first: Distribution, second: Distribution, within: Double): Double =
    val (_, largest) = first.sorted.zipWithIndex.foldLeft((0, 0.0)):
      case ((reached, most), (value, index)) =>
        val next = past(second, reached, value + within)
        (next, most.max((index + 1.0) / first.count - next.toDouble / second.count))
    largest

  private def past(samples: Distribution, index: Int, value: Double): Int =
    val next = samples.sorted.indexWhere(_ > value, index)
    if next < 0 then samples.count else next
