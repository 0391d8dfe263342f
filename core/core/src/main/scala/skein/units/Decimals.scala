package skein.units

import java.util.Locale

/** Formats numbers for reports, with equal digits and decimal points in every locale. */
object Decimals:
  /** Magnitude from which numbers are written as powers of ten; so are those below [[LeastInFull]]. */
  private[units] val MostInFull = 1e12
  private val LeastInFull       = 1e-9

  /** A count with its noun: `1 flight`, `2 flights`.
    *
    * @param one the noun in the singular
    */
  def counted(count: Long, one: String): String = if count == 1 then s"1 $one" else s"$count ${one}s"

  extension (number: Double)
    /** The number with this number of decimals; very large numbers, which have up to 309 digits, as powers of
      * ten. A result of zero has no sign.
      */
    def fixed(decimals: Int): String =
      if number.abs < MostInFull then withoutSignOfZero(String.format(Locale.ROOT, s"%.${decimals}f", number))
      else significant(4)

    /** `fixed`, padded to this width for columns of a table. */
    def fixed(decimals: Int, width: Int): String =
      val text = fixed(decimals)
      " " * (width - text.length) + text

    /** The number with this number of decimals, and always with a sign unless it is zero. */
    def signed(decimals: Int): String =
      val text = fixed(decimals)
      if number.isNaN || text.startsWith("-") || isZero(text) then text else s"+$text"

    /** The number without decimals from 10 on, with one decimal from 1 on, otherwise with two. */
    def brief: String =
      number.fixed(if number.abs >= 9.95 || number == 0 then 0 else if number.abs >= 0.95 then 1 else 2)

    /** The number with at most this number of significant digits; very large and very small numbers as powers
      * of ten.
      */
    def significant(digits: Int): String =
      if number == 0 || !number.isFinite then withoutSignOfZero(number.toString)
      else
        val rounded = java.math.BigDecimal(number).round(java.math.MathContext(digits)).stripTrailingZeros
        if number.abs < MostInFull && number.abs > LeastInFull then rounded.toPlainString
        else rounded.toString.replace("E+", "e").replace("E", "e")

  private def withoutSignOfZero(text: String) = if isZero(text) then text.stripPrefix("-") else text

  private def isZero(text: String) = text.forall(letter => "-0.".contains(letter))
