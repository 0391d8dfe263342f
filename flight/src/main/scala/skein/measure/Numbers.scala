package skein.measure

import java.util.Locale

/** Numbers as text, the same in every locale. */
object Numbers:
  def signed(value: Double): String = (if value < 0 then "" else "+") + fixed(value, 1)

  def fixed(value: Double, decimals: Int): String = String.format(Locale.ROOT, s"%.${decimals}f", value)

  /** Ten and more without decimals, less with one, small ones with two. */
  def brief(value: Double): String =
    fixed(value, if value.abs >= 9.95 || value == 0 then 0 else if value.abs >= 0.95 then 1 else 2)
