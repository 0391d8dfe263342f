package skein.cli

import skein.report.TextTable

/** Formats messages about a user's mistakes. Names and values are from files, command lines and other
  * machines: none of them can move the terminal's cursor, and long ones are cut.
  */
private[cli] object Complaint:

  /** Maximum number of shown characters of a word, and of a line. */
  val MostOfAWord = 200
  val MostOfALine = 1000

  /** Maximum number of shown lines: every setting in a misplaced section is a mistake. */
  val MostLines = 12

  /** @param reason a line for each mistake
    * @return the lines, printable and cut; beyond [[MostLines]], a last line counts the others
    */
  def text(reason: String): String =
    val lines = TextTable.printable(reason).linesIterator.map(line => cut(words(line), MostOfALine)).toVector
    val more  = lines.size - MostLines + 1
    val shown = if more <= 1 then lines else lines.take(MostLines - 1) :+ s"and $more mistakes more"
    shown.mkString("\n")

  /** Refuses words with line breaks or other control characters: no valid name or value has them, and a
    * message with them would not be one line.
    */
  def ofWord(word: String): Option[String] =
    Option.when(word.exists(_.isControl)):
      val shown = word.map(letter => if letter.isControl then f"\\u${letter.toInt}%04x" else letter.toString)
      s"expected no line breaks or other control characters, got '${shown.mkString}'"

  private def words(line: String): String =
    if line.length <= MostOfAWord then line
    else
      """\S+""".r.replaceAllIn(
        line,
        word => java.util.regex.Matcher.quoteReplacement(cut(word.matched, MostOfAWord))
      )

  /** Keeps the start and the end of a text, and states how much is omitted. */
  private def cut(text: String, most: Int): String =
    if text.length <= most then text
    else
      val tail = most / 4
      s"${text.take(most - tail)}… ${text.length - most} letters more …${text.takeRight(tail)}"
