package skein.settings

private[settings] object PlainNumber:
  /** The shortest text without an exponent that is read back as an equal number. */
  def text(number: Double): String = BigDecimal(number).bigDecimal.stripTrailingZeros.toPlainString
