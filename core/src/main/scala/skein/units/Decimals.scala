package skein.units

import java.util.Locale

/** Numbers in what Skein says: the same digits and the same point in every locale. */
object Decimals:
  extension (number: Double)
    /** With so many digits behind the point. */
    def fixed(decimals: Int): String = String.format(Locale.ROOT, s"%.${decimals}f", number)

    /** The same, at least so wide, for columns. */
    def fixed(decimals: Int, width: Int): String =
      String.format(Locale.ROOT, s"%${width}.${decimals}f", number)
