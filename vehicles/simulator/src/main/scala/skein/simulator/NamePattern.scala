package skein.simulator

import scala.collection.mutable.ArrayBuffer

/** A client's regular expression, matched against whole names in time that is linear in the name's length and
  * in the expression's size, for any expression: all ways to match are followed in parallel (K. Thompson,
  * "Regular expression search algorithm", 1968), so nothing is tried twice.
  *
  * It knows ECMAScript's syntax, as AirSim's `std::regex` does, except for back-references and lookahead,
  * which cannot be matched in that time or are not needed for names.
  */
final private[simulator] class NamePattern private (program: NameProgram):
  import NamePattern.*

  private var effort = 0L

  /** Throws [[BadArgument]] once all names together have taken too much effort. Cost: some 5 ns for each
    * instruction and letter, at most 25 ms for all names.
    */
  def matches(name: String): Boolean =
    effort += program.size.toLong * (name.length + 1)
    if effort > MostEffort then throw tooHard
    program.matches(name)

private[simulator] object NamePattern:
  private val LongestPattern = 1000

  /** Most instructions of one expression's program. */
  private val LargestProgram = 5000

  /** Greatest nesting of an expression's groups. */
  private val Deepest = 50

  /** Most instructions executed for one request. */
  private val MostEffort = 5_000_000L

  /** Compiles an expression; throws [[BadArgument]] if it is invalid. */
  def apply(text: String, ignoreCase: Boolean = false): NamePattern =
    if text.length > LongestPattern then
      throw BadArgument(s"a regular expression has at most $LongestPattern characters, not ${text.length}")
    val tree = Reader(text, ignoreCase).all()
    if tree.size > LargestProgram then throw tooHard
    new NamePattern(NameProgram.of(tree))

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

  final private class Reader(text: String, ignoreCase: Boolean):
    private var at    = 0
    private var depth = 0

    def all(): NameTree =
      val read = choices()
      if at < text.length then wrong(s"unmatched '${text(at)}'") else read

    private def wrong(why: String): Nothing =
      throw BadArgument(s"no regular expression: $why at character ${at + 1}")

    private def cased(is: Char => Boolean): Char => Boolean =
      if ignoreCase then c => is(c) || is(Character.toLowerCase(c)) || is(Character.toUpperCase(c)) else is

    private def comes(c: Char)   = at < text.length && text(at) == c
    private def taken(c: Char)   = comes(c) && { at += 1; true }
    private def taken(s: String) = text.startsWith(s, at) && { at += s.length; true }

    private def next(): Char =
      if at >= text.length then wrong("it ends too soon")
      at += 1
      text(at - 1)

    private def choices(): NameTree =
      depth += 1
      if depth > Deepest then wrong("groups nested too deep")
      val found = ArrayBuffer(inOrder())
      while taken('|') do found += inOrder()
      depth -= 1
      if found.size == 1 then found.head else NameTree.OneOf(found.toVector)

    private def inOrder(): NameTree =
      val parts = ArrayBuffer.empty[NameTree]
      while at < text.length && !comes('|') && !comes(')') do parts += repeated(one())
      NameTree.InOrder(parts.toVector)

    private def repeated(what: NameTree): NameTree =
      val times =
        if taken('*') then Some((0, None))
        else if taken('+') then Some((1, None))
        else if taken('?') then Some((0, Some(1)))
        else Option.when(comes('{'))(counts())
      times.fold(what): (least, most) =>
        // For whole names the order of trying more or fewer repetitions does not matter.
        val _ = taken('?')
        if "*+?{".exists(comes) then wrong(s"nothing to repeat before '${text(at)}'")
        NameTree.Times(what, least, most)

    private def counts(): (Int, Option[Int]) =
      at += 1
      val least = number()
      val most  = if !taken(',') then Some(least) else if comes('}') then None else Some(number())
      if !taken('}') then wrong("expected '}'")
      if most.exists(_ < least) then wrong("a count that ends before it begins")
      (least, most)

    private def number(): Int =
      val from = at
      while at < text.length && text(at).isDigit && at - from < 5 do at += 1
      text.substring(from, at).toIntOption.getOrElse(wrong("expected a number"))

    private def one(): NameTree = next() match
      case '('  => group()
      case '['  => NameTree.Letter(oneOfSet())
      case '.'  => NameTree.Letter(c => c != '\n' && c != '\r' && c != '\u2028' && c != '\u2029')
      case '^'  => NameTree.Place((_, place) => place == 0)
      case '$'  => NameTree.Place((name, place) => place == name.length)
      case '\\' => escaped()
      case c @ ('*' | '+' | '?' | '{') =>
        at -= 1
        wrong(s"nothing to repeat before '$c'")
      case c => NameTree.Letter(cased(_ == c))

    private def group(): NameTree =
      if comes('?') && !taken("?:") then wrong("groups other than ( ) and (?: ) are not known here")
      val inside = choices()
      if !taken(')') then wrong("expected ')'") else inside

    private def escaped(): NameTree =
      if taken('b') then NameTree.Place(isEdge)
      else if taken('B') then NameTree.Place((name, place) => !isEdge(name, place))
      else if at < text.length && text(at) >= '1' && text(at) <= '9' then
        wrong("references to groups are not known here")
      else
        kind().map(NameTree.Letter(_)).getOrElse:
          val c = letter()
          NameTree.Letter(cased(_ == c))

    /** Reads an escaped character class, such as `\d`. */
    private def kind(): Option[Char => Boolean] =
      val found =
        for
          letter <- text.lift(at)
          is     <- Kinds.get(letter.toLower)
        yield (c: Char) => is(c) != letter.isUpper
      if found.nonEmpty then at += 1
      found

    private def letter(): Char = next() match
      case 't'                    => '\t'
      case 'n'                    => '\n'
      case 'r'                    => '\r'
      case 'f'                    => '\f'
      case 'v'                    => '\u000b'
      case '0'                    => '\u0000'
      case 'x'                    => hexadecimal(2)
      case 'u'                    => hexadecimal(4)
      case c if c.isLetterOrDigit => wrong(s"unknown escape '\\$c'")
      case c                      => c

    private def hexadecimal(digits: Int): Char =
      val from = at
      while at < text.length && at - from < digits && Character.digit(text(at), 16) >= 0 do at += 1
      if at - from < digits then wrong(s"expected $digits hexadecimal digits")
      Integer.parseInt(text.substring(from, at), 16).toChar

    private def oneOfSet(): Char => Boolean =
      val isOther = taken('^')
      val parts   = ArrayBuffer.empty[Char => Boolean]
      while !comes(']') do parts += partOfSet()
      at += 1
      val all  = parts.toVector
      val isIn = cased(c => all.exists(_(c)))
      c => isIn(c) != isOther

    private def partOfSet(): Char => Boolean =
      if taken("[:") then
        val end = text.indexOf(":]", at)
        if end < 0 then wrong("expected ':]'")
        val name = text.substring(at, end)
        at = end + 2
        Named.getOrElse(name, wrong(s"unknown kind of letters '$name'"))
      else
        member() match
          case Left(kind)   => kind
          case Right(first) =>
            if comes('-') && text.lift(at + 1).exists(_ != ']') then
              at += 1
              member() match
                case Right(last) if last >= first => c => c >= first && c <= last
                case _                            => wrong("a range that ends before it begins")
            else _ == first

    private def member(): Either[Char => Boolean, Char] = next() match
      case '\\' => kind().toLeft(if taken('b') then '\b' else letter())
      case c    => Right(c)

  private def isWord(c: Char) = c < 128 && (c.isLetterOrDigit || c == '_')

  private def isEdge(name: String, place: Int) =
    (place > 0 && isWord(name(place - 1))) != (place < name.length && isWord(name(place)))

  private val Kinds: Map[Char, Char => Boolean] =
    Map('d' -> (c => c >= '0' && c <= '9'), 's' -> (_.isWhitespace), 'w' -> isWord)

  private val Named: Map[String, Char => Boolean] = Map(
    "alpha"  -> (_.isLetter),
    "digit"  -> (_.isDigit),
    "alnum"  -> (_.isLetterOrDigit),
    "upper"  -> (_.isUpper),
    "lower"  -> (_.isLower),
    "space"  -> (_.isWhitespace),
    "punct"  -> (c => c > ' ' && c < 127 && !c.isLetterOrDigit),
    "xdigit" -> (Character.digit(_, 16) >= 0)
  )
