package skein.signal

/** Quantiles of Student's distribution, by which intervals of a few normally distributed values are made. */
object StudentQuantile:
  /** The 97.5 % quantile, within 0.0005; above 30 degrees of freedom by Abramowitz and Stegun, "Handbook of
    * mathematical functions", 26.7.5.
    */
  def twoSided95(degrees: Int): Double =
    if degrees <= table.size then table(degrees - 1)
    else
      val (z, n) = (NormalQuantile.TwoSided95, degrees.toDouble)
      val square = z * z
      z + z * (square + 1) / (4 * n) + z * ((5 * square + 16) * square + 3) / (96 * n * n)

  // For 1, 2, … degrees of freedom: Abramowitz and Stegun, table 26.10.
  private val table = Vector(
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201,
    2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056,
    2.052, 2.048, 2.045, 2.042
  )
