package skein.units

import java.util.Locale

/** Numbers in what Skein says: the same digits and the same point in every locale. */
object Decimals:
  /** `1 flight`, `2 flights`.
    *
    * @param one of them
    */
  def counted(count: Long, one: String): String = if count == 1 then s"1 $one" else s"$count ${one}s"

  extension (number: Double)
    /** With so many digits behind the point. */
    def fixed(decimals: Int): String = String.format(Locale.ROOT, s"%.${decimals}f", number)

    /** The same, at least so wide, for columns. */
    def fixed(decimals: Int, width: Int): String =
      String.format(Locale.ROOT, s"%${width}.${decimals}f", number)

    /** With its sign, and so many digits behind the point. */
    def signed(decimals: Int): String = String.format(Locale.ROOT, s"%+.${decimals}f", number)

    /** Ten and more without decimals, less with one, small ones with two. */
    def brief: String =
      number.fixed(if number.abs >= 9.95 || number == 0 then 0 else if number.abs >= 0.95 then 1 else 2)

    /** With so many significant digits at most. */
    def significant(digits: Int): String =
      if number == 0 || !number.isFinite then number.toString
      else java.math.BigDecimal(number).round(java.math.MathContext(digits)).stripTrailingZeros.toPlainString
