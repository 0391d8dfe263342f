package skein.simulator

import java.util.regex.{Pattern, PatternSyntaxException}

/** A client's regular expression, matched against whole names within a stated effort: some expressions would
  * otherwise take for ever on one name.
  */
final private[simulator] class NamePattern private (pattern: Pattern):
  import NamePattern.*

  /** Throws [[BadArgument]] if it takes too long. */
  def matches(name: String): Boolean =
    try pattern.matcher(Limited(name, Effort())).matches()
    catch case _: StackOverflowError => throw tooHard

private[simulator] object NamePattern:
  private val LongestPattern = 1000

  /** Characters looked at for one name. */
  private val MostEffort = 100_000

  /** Throws [[BadArgument]] if it is no expression. */
  def apply(text: String, ignoreCase: Boolean = false): NamePattern =
    if text.length > LongestPattern then
      throw BadArgument(s"a regular expression has at most $LongestPattern characters, not ${text.length}")
    try new NamePattern(Pattern.compile(text, if ignoreCase then Pattern.CASE_INSENSITIVE else 0))
    catch
      case wrong: PatternSyntaxException =>
        throw BadArgument(s"no regular expression: ${wrong.getDescription}")
      case _: StackOverflowError => throw tooHard

  private def tooHard = BadArgument("the regular expression takes too long")

  final private class Effort:
    private var spent = 0
    def spend(): Unit =
      spent += 1
      if spent > MostEffort then throw tooHard

  final private class Limited(text: CharSequence, effort: Effort) extends CharSequence:
    def length: Int                                     = text.length
    def subSequence(start: Int, end: Int): CharSequence = Limited(text.subSequence(start, end), effort)
    override def toString: String                       = text.toString
    def charAt(index: Int): Char                        =
      effort.spend()
      text.charAt(index)
