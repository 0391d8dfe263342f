package skein.formula

import java.lang.classfile.Opcode
import scala.collection.mutable
import skein.formula.Value.*

/** Traces arithmetic instructions and mathematical functions. An integer or boolean that depends on the
  * inputs is represented by a double, or by 1 and 0, as long as that is exact; otherwise it is refused.
  */
private[formula] final class Arithmetic(trace: Trace, assumed: Assumptions, refuse: String => Nothing):
  import Arithmetic.*

  /** For a number of nanoseconds that was computed from seconds, these seconds. */
  private val secondsOf = mutable.HashMap.empty[Node, Node]

  def ofTwo(opcode: Opcode, a: Value, b: Value): Value = opcode match
    case Opcode.DADD                      => Number(trace.add(plain(a), plain(b)))
    case Opcode.DSUB                      => Number(trace.sub(plain(a), plain(b)))
    case Opcode.DMUL                      => Number(product(number(a), number(b)))
    case Opcode.DDIV                      => Number(trace.div(plain(a), plain(b)))
    case Opcode.DREM                      => refuse("% on doubles; StrictMath.IEEEremainder wraps angles")
    case Opcode.DCMPG                     => Compared(number(a), number(b), 1)
    case Opcode.DCMPL                     => Compared(number(a), number(b), -1)
    case Opcode.LCMP if isTime(a, b)      => Compared(seconds(a), seconds(b), 1)
    case Opcode.LADD if isTime(a, b)      => Time(trace.add(seconds(a), seconds(b)))
    case Opcode.LSUB if isTime(a, b)      => Time(trace.sub(seconds(a), seconds(b)))
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

  /** A product. Nanoseconds times the factor to seconds or milliseconds are computed from the original
    * seconds.
    */
  private def product(a: Node, b: Node): Node =
    if a.isConst && secondsOf.contains(b) then product(b, a)
    else
      secondsOf.get(a) match
        case Some(seconds) if b.is(1e-9) => seconds
        case Some(seconds) if b.is(1e-6) => trace.mul(seconds, trace.const(1e3))
        case Some(_)                     => noNanos()
        case None                        => if secondsOf.contains(b) then noNanos() else trace.mul(a, b)

  /** A number that is no number of nanoseconds. */
  private def plain(value: Value): Node =
    val node = number(value)
    if secondsOf.contains(node) then noNanos() else node

  private def noNanos() =
    refuse(
      "it computes with nanoseconds of a length of time that depends on what is observed, or rounds a number"
    )

  /** Whether a value is a duration that depends on the inputs. */
  private def isTime(values: Value*): Boolean = values.exists:
    settled(_) match
      case _: Time           => true
      case OneOf(_, yes, no) => isTime(yes, no)
      case _                 => false

  private def seconds(value: Value): Node = settled(value) match
    case Time(seconds)         => seconds
    case Long(nanos)           => trace.const(nanos * 1e-9)
    case OneOf(holds, yes, no) => trace.where(holds, seconds(yes), seconds(no))
    case other                 => throw IllegalStateException(s"a length of time was expected, got $other")

  private def nanosOf(value: Value): Node = settled(value) match
    case Time(seconds) =>
      val nanos = trace.mul(seconds, trace.const(1e9))
      if !nanos.isConst then secondsOf(nanos) = seconds
      nanos
    case OneOf(_, yes, no) if isTime(yes, no) => nanosOf(Time(seconds(value)))
    case other                                => trace.const(long(other).toDouble)

  /** Compares two durations like `Long.compare`, or two numbers like `Double.compare` except for NaN and the
    * signs of zeros: −1, 0 or 1.
    */
  def order(a: Node, b: Node): Value =
    val others = trace.where(trace.lt(b, a), trace.const(1), trace.const(0))
    Whole(trace.where(trace.lt(a, b), trace.const(-1), others))

  def orderOf(a: Value, b: Value): Value =
    if isTime(a, b) then order(seconds(a), seconds(b)) else Whole(trace.const(long(a).compare(long(b))))

  def opposite(value: Value): Value =
    if isTime(value) then Time(trace.neg(seconds(value))) else Long(-long(value))

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
        case Opcode.IADD => trace.add(a, b)
        case Opcode.ISUB => trace.sub(a, b)
        case Opcode.IMUL =>
          val product = trace.mul(a, b)
          if !mostOf(product).exists(_ <= Int.MaxValue) then
            refuse(
              "it multiplies a whole number that is observed or remembered, which may overflow; a double does not"
            )
          product
        case Opcode.IAND if isTruth(a, b) => asNumber(trace.and(holds(a), holds(b)))
        case Opcode.IOR if isTruth(a, b)  => asNumber(trace.or(holds(a), holds(b)))
        case Opcode.IXOR if isTruth(a, b) =>
          trace.where(holds(a), asNumber(trace.not(holds(b))), asNumber(holds(b)))
        case other =>
          refuse(
            s"${other.name.toLowerCase(java.util.Locale.ROOT)} of a " +
              "whole number that depends on what is observed"
          )

  private val bounds = mutable.HashMap.empty[Node, Option[Double]]

  /** The greatest magnitude of a whole number that was chosen among constants; None if it has another source.
    */
  private def mostOf(node: Node): Option[Double] = bounds.getOrElseUpdate(
    node,
    if node.isConst then Some(node.value.abs)
    else
      def both(args: Seq[Node])(join: (Double, Double) => Double) =
        mostOf(args(0)).zip(mostOf(args(1))).map(join(_, _))
      node.op match
        case Op.Where        => both(node.args.drop(1))(_.max(_))
        case Op.Add | Op.Sub => both(node.args)(_ + _)
        case Op.Mul          => both(node.args)(_ * _)
        case _               => None
  )

  def asNumber(condition: Node): Node        = trace.where(condition, trace.const(1), trace.const(0))
  private def holds(truth: Node): Node       = trace.not(trace.equal(truth, trace.const(0)))
  private def isTruth(nodes: Node*): Boolean = nodes.forall: node =>
    node.is(0) || node.is(1) || node.op == Op.Where && isTruth(node.args.drop(1)*)

  def converted(value: Value, opcode: Opcode): Value = opcode match
    case Opcode.I2D                          => Number(whole(value))
    case Opcode.I2L                          => Long(known(value, "a long"))
    case Opcode.L2I                          => Whole(trace.const(long(value).toInt))
    case Opcode.L2D                          => Number(nanosOf(value))
    case Opcode.D2I if number(value).isConst => Whole(trace.const(number(value).value.toInt))
    case Opcode.D2L if number(value).isConst => Long(number(value).value.toLong)
    case Opcode.D2I | Opcode.D2L             =>
      refuse("it makes a whole number of one that depends on what is observed; math.floor leaves a double")
    case Opcode.I2B => Whole(trace.const(known(value, "a byte").toByte))
    case Opcode.I2S => Whole(trace.const(known(value, "a short").toShort))
    case Opcode.I2C => Whole(trace.const(known(value, "a character").toChar))
    case _          => noFloats()

  def noFloats(): Nothing = refuse("it computes with floats; formulas are written in doubles")

  /** The condition of a branch that compares two doubles.
    *
    * @param ifUnordered result of the comparison if a double is NaN, see [[Compared]]
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

  /** Represents a function of the JDK by one operation; None for a function that the JDK computes from other
    * functions.
    */
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
      case ("(D)J", _, _) if name == "round" && number(args(0)).isConst =>
        Some(Long(Math.round(number(args(0)).value)))
      case ("(D)J", _, _) if name == "round" && isNanos(number(args(0))) =>
        val nanos = trace.unary(Op.Floor, trace.add(number(args(0)), trace.const(0.5)))
        Some(Time(trace.mul(nanos, trace.const(1e-9))))
      case _ if Composed(name)                         => None
      case ("(II)I" | "(I)I" | "(JJ)J" | "(J)J", _, _) => None
      case _                                           => refuse(
          s"$name is not among the functions of formulas " +
            s"(${(Unary.keys ++ Binary.keys).toSeq.sorted.mkString(", ")})"
        )

  /** Whether a number is a length of time in nanoseconds, as `Span.ofSeconds` and `ofMillis` round it: other
    * rounded numbers are not times.
    */
  private def isNanos(node: Node): Boolean =
    node.op == Op.Mul && node.args.exists(factor => factor.is(1e9) || factor.is(1e6))

  def number(value: Value): Node = settled(value) match
    case Number(node)          => node
    case OneOf(holds, yes, no) => trace.where(holds, number(yes), number(no))
    case other                 => throw IllegalStateException(s"a number was expected, got $other")

  def whole(value: Value): Node = settled(value) match
    case Whole(node)           => node
    case OneOf(holds, yes, no) => trace.where(holds, whole(yes), whole(no))
    case _: Compared           => refuse("it keeps the order of two numbers instead of asking for it")
    case other                 => throw IllegalStateException(s"a whole number was expected, got $other")

  def long(value: Value): scala.Long = decided(value) match
    case Long(number) => number
    case _: Time      => refuse(
        "it computes with a length of time that depends on what is observed; of those, formulas know sums, " +
          "differences, comparisons and toSeconds"
      )
    case other => throw IllegalStateException(s"a long was expected, got $other")

  def known(value: Value, what: String): Int =
    val node = whole(value)
    if node.isConst then node.value.toInt else refuse(s"$what that depends on what is observed")

  def settled(value: Value): Value = value match
    case OneOf(condition, yes, no) => assumed(condition) match
        case Some(holds) => settled(if holds then yes else no)
        case None        => value
    case Unreadable(reason, _) => refuse(reason)
    case _                     => value

  /** The single value under the present assumptions; refuses if several are possible. */
  def decided(value: Value): Value = settled(value) match
    case _: OneOf => refuse("which of two objects it is depends on what is observed")
    case one      => one

  /** Evaluates a property. If a condition chooses between two values, it also chooses between their
    * properties.
    */
  def asked(value: Value)(holds: Value => Node): Node = settled(value) match
    case OneOf(condition, yes, no) =>
      val (ofYes, ofNo) = (asked(yes)(holds), asked(no)(holds))
      if ofYes == ofNo then ofYes
      else trace.or(trace.and(condition, ofYes), trace.and(trace.not(condition), ofNo))
    case one => holds(one)

  /** Chooses between two values by a condition; the result is a [[Value.OneOf]] unless both are numbers or
    * equal.
    */
  def either(condition: Node, a: Value, b: Value): Value = (a, b) match
    case _ if a == b                                      => a
    case (Number(x), Number(y))                           => Number(trace.where(condition, x, y))
    case (Whole(x), Whole(y))                             => Whole(trace.where(condition, x, y))
    case (_: Time, _: (Time | Long)) | (_: Long, _: Time) =>
      Time(trace.where(condition, seconds(a), seconds(b)))
    case (Boxed(x), Boxed(y)) => Boxed(either(condition, x, y))
    case _                    => OneOf(condition, a, b)

  def truth(holds: Boolean): Value  = Whole(trace.const(if holds then 1 else 0))
  def truthOf(holds: Boolean): Node = if holds then trace.always else trace.never

  def unboxed(value: Value): Value = settled(value) match
    case Boxed(inner)          => inner
    case OneOf(holds, yes, no) => either(holds, unboxed(yes), unboxed(no))
    case _                     => refuse("a number was expected in an object")

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

  /** Functions whose results are exact, so that `Math` and `StrictMath` agree. */
  private val Exact =
    Set(Op.Sqrt, Op.Abs, Op.Floor, Op.Ceil, Op.Rint, Op.Signum, Op.Min, Op.Max, Op.Remainder)

  /** Functions that the JDK computes from other functions, in Java code. */
  private val Composed = Set("toRadians", "toDegrees", "clamp")
