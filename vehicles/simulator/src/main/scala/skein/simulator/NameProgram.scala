package skein.simulator

import scala.collection.mutable.ArrayBuffer

/** A [[NamePattern]]'s tree as instructions; all ways through them are followed in parallel. */
final private[simulator] class NameProgram private (code: Array[NameProgram.Step]):
  import NameProgram.*

  def size: Int = code.length

  private var now   = Ways(code.length)
  private var later = Ways(code.length)
  private val open  = Array.ofDim[Int](2 * code.length + 2)

  /** Whether the whole name matches; not thread-safe. */
  def matches(name: String): Boolean =
    now.clear()
    follow(now, 0, name, 0)
    var at = 0
    while at < name.length && now.count > 0 do
      later.clear()
      var i = 0
      while i < now.count do
        code(now(i)) match
          case Step.Letter(is) => if is(name(at)) then follow(later, now(i) + 1, name, at + 1)
          case _               => ()
        i += 1
      val before = now
      now = later
      later = before
      at += 1
    at == name.length && (0 until now.count).exists(i => code(now(i)) == Step.End)

  /** Adds all instructions reachable from there without consuming a letter, each once. */
  private def follow(ways: Ways, from: Int, name: String, at: Int): Unit =
    var left = 1
    open(0) = from
    while left > 0 do
      left -= 1
      val step = open(left)
      if ways.add(step) then
        code(step) match
          case Step.Fork(first, second) =>
            open(left) = first
            open(left + 1) = second
            left += 2
          case Step.Jump(to) =>
            open(left) = to
            left += 1
          case Step.Place(is) =>
            if is(name, at) then
              open(left) = step + 1
              left += 1
          case Step.Letter(_) | Step.End => ()

private[simulator] object NameProgram:
  enum Step:
    case Letter(is: Char => Boolean)
    case Place(is: (String, Int) => Boolean)
    case Fork(first: Int, second: Int)
    case Jump(to: Int)
    case End

  def of(tree: NameTree): NameProgram =
    val code = ArrayBuffer.empty[Step]

    def fork(): Int =
      code += Step.End
      code.size - 1

    def add(tree: NameTree): Unit = tree match
      case NameTree.Letter(is)     => code += Step.Letter(is)
      case NameTree.Place(is)      => code += Step.Place(is)
      case NameTree.InOrder(parts) => parts.foreach(add)
      case NameTree.OneOf(choices) =>
        val ends = choices.init.map: choice =>
          val at = fork()
          add(choice)
          val end = fork()
          code(at) = Step.Fork(at + 1, code.size)
          end
        add(choices.last)
        ends.foreach(end => code(end) = Step.Jump(code.size))
      case NameTree.Times(what, least, most) =>
        for _ <- 1 to least do add(what)
        most match
          case None =>
            val at = fork()
            add(what)
            code += Step.Jump(at)
            code(at) = Step.Fork(at + 1, code.size)
          case Some(times) =>
            val forks = (least until times).map: _ =>
              val at = fork()
              add(what)
              at
            forks.foreach(at => code(at) = Step.Fork(at + 1, code.size))

    add(tree)
    code += Step.End
    NameProgram(code.toArray)

  final private class Ways(size: Int):
    private val all  = Array.ofDim[Int](size)
    private val seen = Array.ofDim[Boolean](size)
    var count        = 0

    def apply(index: Int): Int = all(index)

    def add(step: Int): Boolean =
      val isNew = !seen(step)
      if isNew then
        seen(step) = true
        all(count) = step
        count += 1
      isNew

    def clear(): Unit =
      while count > 0 do
        count -= 1
        seen(all(count)) = false
