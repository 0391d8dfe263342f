package skein.optimise

import skein.units.Expect

/** An objective as users write it, such as `0.7*last10s + 0.3*effort`, optionally preceded by `minimise` or
  * `maximise`.
  *
  * @param terms each term with its weight
  * @param stated the direction, if the text has one
  */
final case class WeightedSum[M](terms: Vector[(Double, M)], stated: Option[Direction])

object WeightedSum:
  private val Number   = """(?:(\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)\s*\*\s*)?"""
  private val Most     = 1e9
  private val Plain    = term("""[A-Za-z]\w*""")
  private val Hyphened = term("""[A-Za-z]\w*(?:-\w+)*""")
  private val Directed = """\s*(minimi[sz]e|maximi[sz]e)\s+(.*)""".r

  private def term(name: String) = s"""\\s*([+-])?\\s*$Number($name)\\s*(?:\\(([^)]*)\\))?\\s*""".r

  /** Reads a sum.
    *
    * @param forms forms of a measure, for error messages
    * @param hyphened whether names may contain hyphens; then a minus between two names needs blanks around it
    * @param measureOf creates a term from a name and the text in brackets after it
    * @return Left says what was expected, what was given, and at which character
    */
  def parse[M](text: String, forms: String, hyphened: Boolean = false)(
      measureOf: (String, Option[String]) => Either[String, M]
  ): Either[String, WeightedSum[M]] =
    val pattern           = if hyphened then Hyphened else Plain
    val (stated, formula) = text match
      case Directed(word, rest) =>
        (Some(if word.startsWith("min") then Direction.Minimise else Direction.Maximise), rest)
      case _ => (None, text)
    val offset = text.length - formula.length

    def terms(from: Int, read: Vector[(Double, M)]): Either[String, Vector[(Double, M)]] =
      if from == formula.length && read.nonEmpty then Right(read)
      else
        pattern.findPrefixMatchOf(formula.substring(from)) match
          case Some(term) if read.isEmpty || term.group(1) != null =>
            val size = Option(term.group(2)).fold(1.0)(_.toDouble)
            for
              _ <- Expect.that(size <= Most):
                s"objective '$text', at character ${offset + from + 1}: expected a weight up to $Most, " +
                  s"got ${term.group(2)}"
              measure <- measureOf(term.group(3), Option(term.group(4)))
                .left
                .map(mistake =>
                  s"objective '$text', at character ${offset + from + term.start(3) + 1}: $mistake"
                )
              all <- terms(
                from + term.end,
                read :+ ((if term.group(1) == "-" then -size else size) -> measure)
              )
            yield all
          case _ =>
            val expected =
              if read.isEmpty then s"[WEIGHT*]MEASURE, where MEASURE is one of $forms" else "+ or -"
            Left(
              s"objective '$text', at character ${offset + from + 1}: " +
                s"expected $expected, got '${formula.substring(from)}'"
            )

    terms(0, Vector.empty).map(WeightedSum(_, stated))
