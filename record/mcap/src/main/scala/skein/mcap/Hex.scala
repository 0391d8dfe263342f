package skein.mcap

/** Hexadecimal digits of numbers, independent of the locale; a format string would use the machine's locale.
  */
private[mcap] object Hex:
  def of(number: Int): String = "0x" + digits(number, 8)

  def ofByte(byte: Int): String = digits(byte & 0xff, 2)

  private def digits(number: Int, count: Int) =
    Integer.toHexString(number).reverse.padTo(count, '0').reverse
