package skein.units

import java.math.{BigDecimal, MathContext, RoundingMode}
import skein.units.Decimals.significant

/** A mean and the half width of its interval, as text with only the significant digits. */
final case class Interval(mean: String, half: String):
  def text: String = s"$mean ± $half"

object Interval:
  /** The half width with two significant digits, and the mean to the last of these digits. If the half width
    * is 0 or not a number, or either is very large, the mean has up to four significant digits.
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
