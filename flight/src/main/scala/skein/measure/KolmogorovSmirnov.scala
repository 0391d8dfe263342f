package skein.measure

/** How far two samples of one quantity are from having one distribution. */
object KolmogorovSmirnov:

  /** The largest difference between the shares of samples up to a value, over all values: 0 for equal
    * samples, 1 for samples that lie wholly apart (Smirnov, 1948).
    */
  def distance(one: Distribution, other: Distribution): Double =
    // At values that occur in either sample, counted past all that are equal to them.
    def from(i: Int, j: Int, largest: Double): Double =
      if i == one.count || j == other.count then largest
      else
        val value          = one.sorted(i).min(other.sorted(j))
        val (nextI, nextJ) = (past(one, i, value), past(other, j, value))
        val apart          = math.abs(nextI.toDouble / one.count - nextJ.toDouble / other.count)
        from(nextI, nextJ, largest.max(apart))
    from(0, 0, 0)

  private def past(samples: Distribution, index: Int, value: Double): Int =
    val next = samples.sorted.indexWhere(_ > value, index)
    if next < 0 then samples.count else next
