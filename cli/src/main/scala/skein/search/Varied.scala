package skein.search

import upickle.default.ReadWriter

/** A setting that is searched between two bounds, by its key. */
final case class Varied(key: String, least: Double, most: Double) derives ReadWriter

object Varied:
  private val Form = """([a-z][a-z0-9-]*)=(-?[\d.]+)\.\.(-?[\d.]+)""".r

  /** Reads `ring-m=4..12`.
    *
    * @return or what was expected, and what came
    */
  def parse(text: String): Either[String, Varied] = text match
    case Form(key, NumberOf(least), NumberOf(most)) if least < most => Right(Varied(key, least, most))
    case _                                                          =>
      Left(s"expected a setting and its bounds, the lower one first, for example ring-m=4..12, came '$text'")

  private object NumberOf:
    def unapply(text: String): Option[Double] = text.toDoubleOption.filter(_.isFinite)
