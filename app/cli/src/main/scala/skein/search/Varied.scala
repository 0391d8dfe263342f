package skein.search

import skein.pickle.Fields
import skein.units.Expect

/** A setting that is searched between two bounds, given by its key. */
final case class Varied(key: String, least: Double, most: Double) derives Fields

object Varied:
  private val Number = """(-?[\d.]+(?:[eE][+-]?\d+)?)"""
  private val Form   = s"([a-z][a-z0-9-]*)=$Number\\.\\.$Number".r

  /** Greatest bound; beyond it, values between two bounds lose their precision. */
  private val MostBound = 1e9

  /** Parses a setting such as `ring-m=4..12`.
    *
    * @return Left says what was expected and what was given
    */
  def parse(text: String): Either[String, Varied] = text match
    case Form(key, NumberOf(least), NumberOf(most)) if least < most =>
      Expect
        .that(least.abs.max(most.abs) <= MostBound):
          s"expected bounds from -1e9 to 1e9, got '$text'"
        .map(_ => Varied(key, least, most))
    case _ =>
      Left(s"expected a setting and its bounds, the lower one first, for example ring-m=4..12, got '$text'")

  private object NumberOf:
    def unapply(text: String): Option[Double] = text.toDoubleOption
