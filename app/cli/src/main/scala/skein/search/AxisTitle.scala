package skein.search

import java.util.Locale
import skein.units.Decimals.significant

/** A searched parameter's title in pictures, derived from its name in files: `turnRateRadPerS` and
  * `turn-rate-rad-per-s` become the turn rate in rad/s.
  *
  * @param unit empty if the name ends in none
  */
final case class AxisTitle(quantity: String, unit: String):

  /** The label of an axis, with the unit if there is one. */
  def text: String = if unit.isEmpty then quantity else s"$quantity, $unit"

  def at(value: Double): String = s"$quantity = ${value.significant(3)} $unit".trim

object AxisTitle:
  def of(name: String): AxisTitle =
    val words = name
      .replaceAll("(?<=[a-z0-9])([A-Z])", "-$1")
      .split('-')
      .toVector
      .map(_.toLowerCase(Locale.ROOT))
    val (ending, unit) = units
      .find((ending, _) => words.size > ending.size && words.endsWith(ending))
      .getOrElse((Vector.empty, ""))
    AxisTitle(words.dropRight(ending.size).mkString(" "), unit)

  /** Endings of names with their units; the longer of two endings first. */
  private val units = Vector(
    "rad-per-s2" -> "rad/s²",
    "rad-per-s"  -> "rad/s",
    "deg-per-s"  -> "°/s",
    "per-s"      -> "1/s",
    "per-m"      -> "1/m",
    "mps2"       -> "m/s²",
    "mps"        -> "m/s",
    "rad"        -> "rad",
    "deg"        -> "°",
    "hz"         -> "Hz",
    "ms"         -> "ms",
    "kg"         -> "kg",
    "m"          -> "m",
    "s"          -> "s"
  ).map((ending, unit) => (ending.split('-').toVector, unit))
