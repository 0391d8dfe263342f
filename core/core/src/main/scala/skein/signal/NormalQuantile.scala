package skein.signal

/** The inverse of the standard normal cumulative distribution function, to a relative error of 1.2 · 10^−9^.
  *
  * Source: P. J. Acklam's rational approximation (2003); `LatencyDistributionSuite` compares it with
  * tabulated values.
  */
private[skein] object NormalQuantile:
  /** Number of standard deviations from the mean within which a normal variable lies with 95 % probability.
    */
  val TwoSided95 = 1.959964

  private val tail = 0.02425

  def apply(p: Double): Double =
    if p < tail then lower(math.sqrt(-2 * StrictMath.log(p)))
    else if p > 1 - tail then -lower(math.sqrt(-2 * StrictMath.log1p(-p)))
    else centre(p - 0.5)

  private def centre(q: Double): Double =
    val r         = q * q
    val numerator =
      ((((-3.969683028665376e1 * r + 2.209460984245205e2) * r - 2.759285104469687e2) * r +
        1.383577518672690e2) * r - 3.066479806614716e1) * r + 2.506628277459239
    val denominator =
      ((((-5.447609879822406e1 * r + 1.615858368580409e2) * r - 1.556989798598866e2) * r +
        6.680131188771972e1) * r - 1.328068155288572e1) * r + 1
    q * numerator / denominator

  private def lower(q: Double): Double =
    val numerator =
      ((((-7.784894002430293e-3 * q - 3.223964580411365e-1) * q - 2.400758277161838) * q -
        2.549732539343734) * q + 4.374664141464968) * q + 2.938163982698783
    val denominator =
      (((7.784695709041462e-3 * q + 3.224671290700398e-1) * q + 2.445134137142996) * q +
        3.754408661907416) * q + 1
    numerator / denominator
