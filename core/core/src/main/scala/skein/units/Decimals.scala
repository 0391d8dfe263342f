package skein.units

import java.util.Locale

/** Formats numbers in reports: equal digits and decimal points in every locale. */
object Decimals:
  /** From this size on, and below the least, numbers are written as powers of ten. */
  private[units] val MostInFull = 1e12
  private val LeastInFull       = 1e-9

  /** A count with its noun: `1 flight`, `2 flights`.
    *
    * @param one the singular
    */
  def counted(count: Long, one: String): String = if count == 1 then s"1 $one" else s"$count ${one}s"

  extension (number: Double)
    /** With this number of decimals; very large numbers, of up to 309 digits, as powers of ten. What rounds
      * to zero has no sign.
      */
    def fixed(decimals: Int): String =
      if number.abs < MostInFull then withoutSignOfZero(String.format(Locale.ROOT, s"%.${decimals}f", number))
      else significant(4)

    /** `fixed`, padded to this width for columns. */
    def fixed(decimals: Int, width: Int): String =
      val text = fixed(decimals)
      " " * (width - text.length) + text

    /** With this number of decimals, and always with a sign. */
    def signed(decimals: Int): String =
      val text = fixed(decimals)
      if number.isNaN || text.startsWith("-") || isZero(text) then text else s"+$text"

    /** Numbers from 10 on without decimals, smaller ones with one, small ones with two. */
    def brief: String =
      number.fixed(if number.abs >= 9.95 || number == 0 then 0 else if number.abs >= 0.95 then 1 else 2)

    /** With at most this number of significant digits; very large and very small numbers as powers of ten. */
    def significant(digits: Int): String =
      if number == 0 || !number.isFinite then withoutSignOfZero(number.toString)
      else
        val rounded = java.math.BigDecimal(number).round(java.math.MathContext(digits)).stripTrailingZeros
        if number.abs < MostInFull && number.abs > LeastInFull then rounded.toPlainString
        else rounded.toString.replace("E+", "e").replace("E", "e")

  private def withoutSignOfZero(text: String) = if isZero(text) then text.stripPrefix("-") else text

  private def isZero(text: String) = text.forall(letter => "-0.".contains(letter))
