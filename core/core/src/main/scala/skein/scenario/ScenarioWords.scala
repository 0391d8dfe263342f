package skein.scenario

import scala.collection.mutable
import scala.util.control.NoStackTrace
import skein.formula.Node

/** A mistake in a line of a [[ScenarioFile]]: what was expected, and what was given. */
private[scenario] final class ScenarioMistake(what: String) extends RuntimeException(what), NoStackTrace

private[scenario] object ScenarioMistake:
  def wrong(what: String): Nothing = throw ScenarioMistake(what)

  private val MostShown = 60

  /** A part of the file for a message: shortened, and with printable letters only. */
  def shown(text: String): String =
    val cut = if text.length <= MostShown then text else text.take(MostShown) + "…"
    cut.map(letter => if letter.isControl then '?' else letter)

/** The nodes of earlier lines, by their numbers. */
private[scenario] trait ScenarioNumbers:
  def size: Int
  def apply(id: Int): Node
  def isCondition(id: Int): Boolean
  def reads(node: Node): Boolean

/** The words of one line of a [[ScenarioFile]], separated by spaces. `"…"` is one word, in which `\"` stands
  * for `"`, and `\\` for `\`.
  *
  * @param nodes the nodes of earlier lines
  */
private[scenario] final class ScenarioWords(line: String, nodes: ScenarioNumbers):
  import ScenarioMistake.*
  import ScenarioWords.*

  private val words = split()
  private var at    = 0

  private def split(): Vector[String] =
    if line.length > MostLetters then
      wrong(s"expected at most $MostLetters letters in a line, got ${line.length}")
    val found = Vector.newBuilder[String]
    var i     = 0
    while i < line.length do
      if line(i) == ' ' then i += 1
      else if line(i) == '"' then
        val word = mutable.StringBuilder()
        i += 1
        while i < line.length && line(i) != '"' do
          if line(i) == '\\' && i + 1 < line.length then i += 1
          word += line(i)
          i += 1
        if i >= line.length then wrong("expected a quotation mark at the end of a text, got the line's end")
        i += 1
        if i < line.length && line(i) != ' ' then wrong("expected a space after a quotation mark, got none")
        found += word.result()
      else
        val end = line.indexOf(' ', i) match
          case -1   => line.length
          case some => some
        found += line.substring(i, end)
        i = end
    val all = found.result()
    if all.exists(_.exists(_.isControl)) then wrong("expected printable letters, got a control character")
    all

  private def hasMore = at < words.size

  def text(what: String, most: Int = MostWord): String =
    if !hasMore then wrong(s"expected $what, got the line's end")
    val word = words(at)
    at += 1
    if word.length > most then wrong(s"expected $what of at most $most letters, got ${word.length}")
    word

  def name(what: String): String =
    val word = text(what)
    if word.isBlank then wrong(s"expected $what, got an empty text")
    word

  /** Reads a name of small letters, digits and dashes. */
  def key(what: String): String =
    val word = text(what)
    if !word.matches("[a-z][a-z0-9]*(-[a-z0-9]+)*") then
      wrong(s"expected $what of small letters and digits, with dashes between words, got '${shown(word)}'")
    word

  def number(what: String, isRight: Double => Boolean = _.isFinite): Double =
    val word = text(what)
    word.toDoubleOption
      .filter(isRight)
      .getOrElse(wrong(s"expected $what, a number, got '${shown(word)}'"))

  def whole(what: String, most: Int): Int =
    val word = text(what)
    word.toIntOption
      .filter(each => each >= 0 && each < most)
      .getOrElse(wrong(s"expected $what, a whole number from 0 to ${most - 1}, got '${shown(word)}'"))

  def isNext(word: String): Boolean =
    val same = hasMore && words(at) == word
    if same then at += 1
    same

  def oneOf[A](what: String, options: Iterable[A])(word: A => String): A =
    val came = text(what)
    options.find(word(_) == came).getOrElse(
      wrong(s"expected $what, one of ${options.map(word).mkString(", ")}, got '${shown(came)}'")
    )

  private def node(isCondition: Boolean): Node =
    val what = if isCondition then "a condition's node" else "a number's node"
    val word = text(what)
    val id   = word.toIntOption.filter(each => each >= 0 && each < nodes.size).getOrElse:
      val which = if nodes.size == 0 then "of which there is none" else s"from 0 to ${nodes.size - 1}"
      wrong(s"expected $what of an earlier line, $which, got '${shown(word)}'")
    if nodes.isCondition(id) != isCondition then
      wrong(s"expected $what, got node $id, which is a ${if isCondition then "number" else "condition"}")
    nodes(id)

  def value(): Node     = node(isCondition = false)
  def condition(): Node = node(isCondition = true)

  /** Reads a number that depends only on settings, not on observations. */
  def fixed(): Node =
    val one = value()
    if nodes.reads(one) then
      wrong(
        s"expected a number of settings alone, got node ${words(at - 1)}, which depends on what is observed"
      )
    one

  def allFixed(): Vector[Node] =
    val found = Vector.newBuilder[Node]
    while hasMore do found += fixed()
    found.result()

  def end(): Unit = if hasMore then wrong(s"expected the line's end, got '${shown(words(at))}'")

private[scenario] object ScenarioWords:
  private val MostLetters = 4000
  private val MostWord    = 60
