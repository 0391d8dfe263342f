package skein.formula

import java.lang.classfile.Opcode
import skein.formula.Value.*

/** What instructions compute of numbers, and the functions of formulas. A whole number or a truth that
  * depends on what is observed is a double, or 1 and 0, as far as that goes; the rest is refused.
  */
private[formula] final class Arithmetic(trace: Trace, refuse: String => Nothing):
  import Arithmetic.*

  def ofTwo(opcode: Opcode, a: Value, b: Value): Value = opcode match
    case Opcode.DADD                      => Number(trace.add(number(a), number(b)))
    case Opcode.DSUB                      => Number(trace.sub(number(a), number(b)))
    case Opcode.DMUL                      => Number(trace.mul(number(a), number(b)))
    case Opcode.DDIV                      => Number(trace.div(number(a), number(b)))
    case Opcode.DREM                      => refuse("% on doubles; StrictMath.IEEEremainder wraps angles")
    case Opcode.DCMPG                     => Compared(number(a), number(b), 1)
    case Opcode.DCMPL                     => Compared(number(a), number(b), -1)
    case Opcode.LCMP                      => Whole(trace.const(long(a).compare(long(b))))
    case Opcode.LADD                      => Long(long(a) + long(b))
    case Opcode.LSUB                      => Long(long(a) - long(b))
    case Opcode.LMUL                      => Long(long(a) * long(b))
    case Opcode.LDIV                      => Long(long(a) / long(b))
    case Opcode.LREM                      => Long(long(a) % long(b))
    case Opcode.LAND                      => Long(long(a) & long(b))
    case Opcode.LOR                       => Long(long(a) | long(b))
    case Opcode.LXOR                      => Long(long(a) ^ long(b))
    case _ if opcode.name.startsWith("F") => noFloats()
    case _                                => Whole(wholes(opcode, whole(a), whole(b)))

  /** The negative of a whole number. */
  def negated(a: Node): Node =
    if a.isConst then trace.const(-a.value.toInt) else trace.sub(trace.const(0), a)

  def wholes(opcode: Opcode, a: Node, b: Node): Node =
    if a.isConst && b.isConst then
      val (x, y) = (a.value.toInt, b.value.toInt)
      trace.const(opcode match
        case Opcode.IADD               => x + y
        case Opcode.ISUB               => x - y
        case Opcode.IMUL               => x * y
        case Opcode.IDIV if y != 0     => x / y
        case Opcode.IREM if y != 0     => x % y
        case Opcode.IDIV | Opcode.IREM => refuse("it divides by zero")
        case Opcode.IAND               => x & y
        case Opcode.IOR                => x | y
        case Opcode.IXOR               => x ^ y
        case Opcode.ISHL               => x << y
        case Opcode.ISHR               => x >> y
        case Opcode.IUSHR              => x >>> y
        case other => refuse(s"${other.name.toLowerCase(java.util.Locale.ROOT)} is not arithmetic"))
    else
      opcode match
        case Opcode.IADD                  => trace.add(a, b)
        case Opcode.ISUB                  => trace.sub(a, b)
        case Opcode.IMUL                  => trace.mul(a, b)
        case Opcode.IAND if isTruth(a, b) => asNumber(trace.and(holds(a), holds(b)))
        case Opcode.IOR if isTruth(a, b)  => asNumber(trace.or(holds(a), holds(b)))
        case Opcode.IXOR if isTruth(a, b) =>
          trace.where(holds(a), asNumber(trace.not(holds(b))), asNumber(holds(b)))
        case other =>
          refuse(
            s"${other.name.toLowerCase(java.util.Locale.ROOT)} of a " +
              "whole number that depends on what is observed"
          )

  def asNumber(condition: Node): Node        = trace.where(condition, trace.const(1), trace.const(0))
  private def holds(truth: Node): Node       = trace.not(trace.equal(truth, trace.const(0)))
  private def isTruth(nodes: Node*): Boolean = nodes.forall: node =>
    node.is(0) || node.is(1) || node.op == Op.Where && isTruth(node.args.drop(1)*)

  def converted(value: Value, opcode: Opcode): Value = opcode match
    case Opcode.I2D                          => Number(whole(value))
    case Opcode.I2L                          => Long(known(value, "a long"))
    case Opcode.L2I                          => Whole(trace.const(long(value).toInt))
    case Opcode.L2D                          => Number(trace.const(long(value).toDouble))
    case Opcode.D2I if number(value).isConst => Whole(trace.const(number(value).value.toInt))
    case Opcode.D2L if number(value).isConst => Long(number(value).value.toLong)
    case Opcode.D2I | Opcode.D2L             =>
      refuse("it makes a whole number of one that depends on what is observed; math.floor leaves a double")
    case Opcode.I2B => Whole(trace.const(known(value, "a byte").toByte))
    case Opcode.I2S => Whole(trace.const(known(value, "a short").toShort))
    case Opcode.I2C => Whole(trace.const(known(value, "a character").toChar))
    case _          => noFloats()

  def noFloats(): Nothing = refuse("it computes with floats; formulas are written in doubles")

  /** Whether a branch is taken that asks how two doubles compare.
    *
    * @param ifUnordered see [[Compared]]
    */
  def ofComparison(opcode: Opcode, a: Node, b: Node, ifUnordered: Int): Node =
    val high = ifUnordered > 0
    opcode match
      case Opcode.IFLT => if high then trace.lt(a, b) else trace.not(trace.le(b, a))
      case Opcode.IFLE => if high then trace.le(a, b) else trace.not(trace.lt(b, a))
      case Opcode.IFGT => if high then trace.not(trace.le(a, b)) else trace.lt(b, a)
      case Opcode.IFGE => if high then trace.not(trace.lt(a, b)) else trace.le(b, a)
      case Opcode.IFEQ => trace.equal(a, b)
      case _           => trace.not(trace.equal(a, b))

  def ofWholes(how: String, a: Node, b: Node): Node = how match
    case "EQ" => trace.equal(a, b)
    case "NE" => trace.not(trace.equal(a, b))
    case "LT" => trace.lt(a, b)
    case "GE" => trace.not(trace.lt(a, b))
    case "GT" => trace.lt(b, a)
    case "LE" => trace.not(trace.lt(b, a))

  /** A function of the JDK's, if it is none that is made of others there. */
  def function(owner: String, name: String, desc: String, args: Vector[Value]): Option[Value] =
    val exact          = owner.endsWith("StrictMath")
    def strict(): Unit =
      if !exact then
        refuse(s"Math.$name, whose last bit is the processor's own; StrictMath.$name is the same everywhere")
    (desc, Unary.get(name), Binary.get(name)) match
      case ("(D)D", Some(op), _) =>
        if !Exact(op) then strict()
        Some(Number(trace.unary(op, number(args(0)))))
      case ("(DD)D", _, Some(op)) =>
        if !Exact(op) then strict()
        Some(Number(trace.binary(op, number(args(0)), number(args(1)))))
      case _ if Composed(name)      => None
      case ("(II)I" | "(I)I", _, _) => None
      case _                        => refuse(
          s"$name is not among the functions of formulas " +
            s"(${(Unary.keys ++ Binary.keys).toSeq.sorted.mkString(", ")})"
        )

  def number(value: Value): Node = decided(value) match
    case Number(node) => node
    case other        => throw IllegalStateException(s"a number was expected, came $other")

  def whole(value: Value): Node = decided(value) match
    case Whole(node) => node
    case _: Compared => refuse("it keeps the order of two numbers instead of asking for it")
    case other       => throw IllegalStateException(s"a whole number was expected, came $other")

  def long(value: Value): scala.Long = decided(value) match
    case Long(number) => number
    case other        => throw IllegalStateException(s"a long was expected, came $other")

  def known(value: Value, what: String): Int =
    val node = whole(value)
    if node.isConst then node.value.toInt else refuse(s"$what that depends on what is observed")

  def decided(value: Value): Value =
    if value == Undecided then refuse("which of two objects it is depends on what is observed") else value

  def truth(holds: Boolean): Value  = Whole(trace.const(if holds then 1 else 0))
  def truthOf(holds: Boolean): Node = if holds then trace.always else trace.never

  def unboxed(value: Value): Value = decided(value) match
    case Boxed(inner) => inner
    case _            => refuse("a number was expected in an object")

private object Arithmetic:
  private val Unary = Map(
    "sqrt"   -> Op.Sqrt,
    "abs"    -> Op.Abs,
    "sin"    -> Op.Sin,
    "cos"    -> Op.Cos,
    "asin"   -> Op.Asin,
    "acos"   -> Op.Acos,
    "atan"   -> Op.Atan,
    "exp"    -> Op.Exp,
    "tanh"   -> Op.Tanh,
    "floor"  -> Op.Floor,
    "ceil"   -> Op.Ceil,
    "rint"   -> Op.Rint,
    "signum" -> Op.Signum
  )

  private val Binary = Map(
    "min"           -> Op.Min,
    "max"           -> Op.Max,
    "atan2"         -> Op.Atan2,
    "hypot"         -> Op.Hypot,
    "IEEEremainder" -> Op.Remainder
  )

  /** Those that are exact, so that Math and StrictMath are one. */
  private val Exact =
    Set(Op.Sqrt, Op.Abs, Op.Floor, Op.Ceil, Op.Rint, Op.Signum, Op.Min, Op.Max, Op.Remainder)

  /** Made of others in the JDK's own code. */
  private val Composed = Set("toRadians", "toDegrees", "clamp")
