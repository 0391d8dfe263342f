package skein.report

/** Breaks a text into lines of limited width. */
object Paragraph:

  /** Breaks a text between words. A word that is longer has a line of its own.
    *
    * @param width the maximum width of a line, in characters
    */
  def lines(text: String, width: Int): Vector[String] =
    text.split(' ').filter(_.nonEmpty).foldLeft(Vector.empty[String]): (lines, word) =>
      lines.lastOption match
        case Some(last) if last.length + 1 + word.length <= width => lines.init :+ s"$last $word"
        case _                                                    => lines :+ word
