package skein.units

import java.math.{BigDecimal, MathContext, RoundingMode}
import skein.units.Decimals.significant

/** A mean and the half width of the interval around it, with the digits that mean something. */
final case class Interval(mean: String, half: String):
  def text: String = s"$mean ± $half"

object Interval:
  /** The half width with two significant digits, the mean to that decimal place. Where the half width is 0 or
    * not a number, or either is very large, the mean has up to four significant digits.
    */
  def of(mean: Double, half: Double): Interval =
    if half == 0 then Interval(mean.significant(4), "0")
    else if !(mean.abs < Decimals.MostInFull && half < Decimals.MostInFull) then
      Interval(mean.significant(4), half.significant(2))
    else
      val rounded  = BigDecimal(half).round(twoDigits)
      val decimals = rounded.scale + 2 - rounded.precision
      Interval(
        BigDecimal(mean).setScale(decimals, RoundingMode.HALF_UP).toPlainString,
        rounded.setScale(decimals).toPlainString
      )

  private val twoDigits = MathContext(2, RoundingMode.HALF_UP)
