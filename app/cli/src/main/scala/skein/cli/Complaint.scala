package skein.cli

import skein.report.TextTable

/** What is wrong with what a user gave, as it is printed. Names and values come from files, command lines and
  * other machines: nothing of them moves the terminal's cursor, and long ones are cut.
  */
private[cli] object Complaint:

  /** Letters of a word that are shown, and of a line. */
  val MostOfAWord = 200
  val MostOfALine = 1000

  /** @param reason a line for each mistake
    * @return as many lines
    */
  def text(reason: String): String =
    TextTable.printable(reason).linesIterator.map(line => cut(words(line), MostOfALine)).mkString("\n")

  /** Line breaks and other control characters are in no name and value that a command takes: no message could
    * be one line with them.
    */
  def ofWord(word: String): Option[String] =
    Option.when(word.exists(_.isControl)):
      val shown = word.map(letter => if letter.isControl then f"\\u${letter.toInt}%04x" else letter.toString)
      s"expected no line breaks or other control characters, came '${shown.mkString}'"

  private def words(line: String): String =
    if line.length <= MostOfAWord then line
    else
      """\S+""".r.replaceAllIn(
        line,
        word => java.util.regex.Matcher.quoteReplacement(cut(word.matched, MostOfAWord))
      )

  /** With its beginning and its end, and how much is not shown. */
  private def cut(text: String, most: Int): String =
    if text.length <= most then text
    else
      val tail = most / 4
      s"${text.take(most - tail)}… ${text.length - most} letters more …${text.takeRight(tail)}"
