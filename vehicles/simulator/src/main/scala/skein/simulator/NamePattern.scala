package skein.simulator

import com.google.re2j.{Pattern, PatternSyntaxException}
import scala.util.matching.Regex

/** A client's regular expression, matched against whole names by RE2/J, whose time is linear in the name's
  * length and in the expression's size, for any expression.
  *
  * It knows most of ECMAScript's syntax, as AirSim's `std::regex` does, except for back-references and
  * lookahead, which cannot be matched in that time.
  */
final private[simulator] class NamePattern private (pattern: Pattern):
  import NamePattern.*

  private var effort = 0L

  /** Throws [[BadArgument]] once all names together have taken too much effort. Cost: some 40 ns for each
    * instruction and letter, at most 40 ms for all names.
    */
  def matches(name: String): Boolean =
    effort += pattern.programSize.toLong * (name.length + 1)
    if effort > MostEffort then throw tooHard
    pattern.matches(name)

private[simulator] object NamePattern:
  private val LongestPattern = 1000

  /** Maximum number of an expression's letters after RE2/J has written out its counted repetitions. */
  private val MostWrittenOut = 20_000

  /** Greatest nesting of an expression's groups. */
  private val Deepest = 50

  /** Maximum number of instructions executed for one request. */
  private val MostEffort = 1_000_000L

  private val CodePoint = """(?<!\\)((?:\\\\)*)\\u([0-9A-Fa-f]{4})""".r

  /** An escape, or a set of letters: neither has groups or counts. */
  private val Letter = """\\.|\[\^?]?(?:\[:\w+:]|\\.|[^]\\])*]""".r
  private val Count  = """\{(\d{1,5})(?:,(\d{0,5}))?}""".r

  /** Compiles an expression; throws [[BadArgument]] if it is invalid. */
  def apply(text: String, ignoreCase: Boolean = false): NamePattern =
    if text.length > LongestPattern then
      throw BadArgument(s"a regular expression has at most $LongestPattern characters, not ${text.length}")
    // RE2/J's quotations differ from those of ECMAScript.
    if text.contains("\\Q") then wrong("invalid escape sequence", text)
    val groups = Letter.replaceAllIn(text, "x")
    if depths(groups).max > Deepest then wrong(s"groups nested deeper than $Deepest", text)
    if writtenOut(groups) > MostWrittenOut then throw tooHard
    try
      new NamePattern(Pattern.compile(
        CodePoint.replaceAllIn(text, """$1\\x{$2}"""),
        if ignoreCase then Pattern.CASE_INSENSITIVE else 0
      ))
    catch
      case refused: PatternSyntaxException =>
        // RE2/J reports a surplus parenthesis as an internal error of its stack.
        wrong(
          if refused.getDescription.contains("internal") then "unexpected )" else refused.getDescription,
          text
        )

  private def wrong(why: String, text: String): Nothing =
    throw BadArgument(s"no regular expression: $why in '$text'")

  /** Number of groups that are open before each letter. */
  private def depths(groups: String): IndexedSeq[Int] = groups.scanLeft(0): (depth, letter) =>
    if letter == '(' then depth + 1 else if letter == ')' then depth - 1 else depth

  /** Upper bound of the letters with counts written out: the product of each depth's greatest count. */
  private def writtenOut(groups: String): Double =
    val depth  = depths(groups)
    val counts =
      Count.findAllMatchIn(groups).toVector.groupMapReduce(count => depth(count.start))(most)(_.max(_))
    groups.length * counts.values.product

  private def most(count: Regex.Match): Double =
    count.subgroups.flatMap(Option(_)).flatMap(_.toDoubleOption).maxOption.getOrElse(1.0).max(1)

  /** Whether a name matches a pattern in which `*` stands for anything and `?` for one letter, ignoring case.
    * Cost: at most the product of the lengths.
    */
  def isLike(name: String, wildcard: String): Boolean =
    var (at, in)      = (0, 0)
    var (again, from) = (-1, 0) // after the last `*`, and its first unmatched position
    var isLike        = true
    while isLike && at < name.length do
      if in < wildcard.length && wildcard(in) == '*' then
        in += 1
        again = in
        from = at
      else if in < wildcard.length && (wildcard(in) == '?' || isSame(wildcard(in), name(at))) then
        in += 1
        at += 1
      else if again >= 0 then
        from += 1
        at = from
        in = again
      else isLike = false
    isLike && wildcard.drop(in).forall(_ == '*')

  private def isSame(one: Char, other: Char) =
    one == other || Character.toLowerCase(Character.toUpperCase(one)) ==
      Character.toLowerCase(Character.toUpperCase(other))

  private def tooHard = BadArgument("the regular expression takes too long")
