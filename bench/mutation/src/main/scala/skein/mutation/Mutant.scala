package skein.mutation

import java.nio.file.Path
import scala.util.matching.Regex

/** One change of one source file.
  *
  * @param line
  *   and column count from 1
  * @param at
  *   where in the file `before` stands
  */
final case class Mutant(
    module: String,
    file: Path,
    line: Int,
    column: Int,
    at: Int,
    before: String,
    after: String
):
  /** Whether a number was changed: many a limit is a choice that no test should repeat. */
  def isNumber: Boolean = before.head.isDigit

  def applied(source: String): String = source.patch(at, after, before.length)

  override def toString: String = s"${file.getFileName}:$line:$column  $before  →  $after"

object Mutant:

  /** All mutants of a source: one operator, comparison, condition, truth value or number changed in each. */
  def of(module: String, file: Path, source: String): Vector[Mutant] =
    val isCode = SourceText.code(source)
    val starts = source.indices.filter(index => index == 0 || source(index - 1) == '\n')
    for
      (start, line) <- starts.zipWithIndex.toVector
      end  = source.indexOf('\n', start) match { case -1 => source.length; case found => found }
      text = source.substring(start, end)
      if !Declares.matches(text)
      rule  <- rules
      found <- rule.pattern.findAllMatchIn(text).toVector
      at = start + found.start(1)
      if (at until at + found.group(1).length).forall(isCode)
      after <- rule.instead(found.group(1)) if after != found.group(1)
    yield Mutant(module, file, line + 1, found.start(1) + 1, at, found.group(1), after)

  /** Lines on which nothing is computed. */
  private val Declares = """\s*(package|import|@|\*|//|sealed|private object|object|enum) ?.*""".r

  /** @param pattern
    *   its first group is what is replaced
    */
  private final case class Rule(pattern: Regex, instead: String => Seq[String])

  private def swap(one: String, others: String*) = Rule(s"(?<= )(${Regex.quote(one)})(?= )".r, _ => others)

  private def call(one: String, other: String) =
    Rule(s"(?<=\\.)(${Regex.quote(one)})(?![\\w])".r, _ => Seq(other))

  private val rules: Vector[Rule] = Vector(
    swap("<", "<=", ">="),
    swap("<=", "<", ">"),
    swap(">", ">=", "<="),
    swap(">=", ">", "<"),
    swap("==", "!="),
    swap("!=", "=="),
    swap("&&", "||"),
    swap("||", "&&"),
    swap("+", "-"),
    swap("-", "+"),
    swap("*", "/"),
    swap("/", "*"),
    swap("+=", "-="),
    swap("-=", "+="),
    swap("||=", "&&="),
    call("min", "max"),
    call("max", "min"),
    call("exists", "forall"),
    call("forall", "exists"),
    call("filter", "filterNot"),
    call("filterNot", "filter"),
    call("isEmpty", "nonEmpty"),
    call("nonEmpty", "isEmpty"),
    call("isDefined", "isEmpty"),
    call("headOption", "lastOption"),
    call("lastOption", "headOption"),
    call("head", "last"),
    call("last", "head"),
    call("take", "drop"),
    call("drop", "take"),
    call("takeRight", "dropRight"),
    call("dropRight", "takeRight"),
    Rule(raw"\b(true|false)\b".r, text => Seq(if text == "true" then "false" else "true")),
    Rule(raw"(?<![\w)\]])(!)(?=[\w(])".r, _ => Seq("")),
    Rule(raw"\bif (.+?) then".r, condition => Seq(s"!($condition)")),
    Rule(raw"\bcase .* if (.+) =>".r, condition => Seq(s"!($condition)")),
    Rule(raw"(?<![\w.])(?<!\de-)(\d[\d_]*L?)(?![\w.])".r, number => Seq(plusOne(number))),
    Rule(
      raw"(?<![\w.])(\d[\d_]*\.\d+(?:[eE]-?\d+)?|\d+[eE]-?\d+)(?![\w.])".r,
      number => Seq(s"(2 * $number + 1)")
    )
  )

  private def plusOne(number: String): String =
    val digits = number.stripSuffix("L").replace("_", "")
    (BigInt(digits) + 1).toString + (if number.endsWith("L") then "L" else "")

/** Tells code from comments and texts. */
private object SourceText:

  /** By position: whether it is code. What is computed inside of texts counts as text. */
  def code(source: String): Int => Boolean =
    val is    = Array.fill(source.length)(true)
    var index = 0

    def skip(to: Int): Unit =
      while index < to.min(source.length) do
        is(index) = false
        index += 1

    def behind(end: String, from: Int): Int = source.indexOf(end, from) match
      case -1    => source.length
      case found => found + end.length

    while index < source.length do
      if source.startsWith("//", index) then skip(behind("\n", index))
      else if source.startsWith("/*", index) then skip(behind("*/", index))
      else if source.startsWith("\"\"\"", index) then skip(behind("\"\"\"", index + 3))
      else if source(index) == '"' then skip(endOfText(source, index))
      else if source(index) == '\'' && source.startsWith("'", index + 2) then skip(index + 3)
      else index += 1
    is(_)

  private def endOfText(source: String, start: Int): Int =
    var (at, depth) = (start + 1, 0)
    while at < source.length && (depth > 0 || source(at) != '"') && source(at) != '\n' do
      if source(at) == '\\' then at += 1
      else if source.startsWith("${", at) then depth += 1
      else if source(at) == '}' && depth > 0 then depth -= 1
      at += 1
    at + 1
