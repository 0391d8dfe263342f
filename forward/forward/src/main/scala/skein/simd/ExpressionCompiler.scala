package skein.simd

import scala.collection.mutable
import skein.formula.{Node, Op, Untraceable}

/** Generates code for expressions, for any instruction set. This class determines all bits of a result:
  * elementary functions are the polynomials of [[LaneMath]], inlined; products are fused with sums; minimum
  * and maximum are comparisons. So all machines whose single operations round as IEEE 754 requires agree to
  * the bit.
  *
  * The result of an operation is identified by the number of its register or variable. It is a float, a
  * condition, or the 32 bits of a float. Mutable; one instance per stretch of code.
  */
private[skein] abstract class ExpressionCompiler:
  import ExpressionCompiler.Round

  /** Register or variable of each node that is already computed. */
  protected final val slots   = mutable.HashMap.empty[Node, Int]
  private val sinesAndCosines = mutable.HashMap.empty[Node, (Int, Int)]

  // The operations of a machine.

  protected def input(number: Int): Int
  protected def parameter(number: Int): Int
  protected def constant(value: Float): Int
  protected def neg(a: Int): Int
  protected def abs(a: Int): Int
  protected def sqrt(a: Int): Int
  protected def add(a: Int, b: Int): Int
  protected def sub(a: Int, b: Int): Int
  protected def mul(a: Int, b: Int): Int
  protected def div(a: Int, b: Int): Int

  /** a · b + c, rounded once: a fused multiply-add. */
  protected def fma(a: Int, b: Int, c: Int): Int
  protected def choose(otherwise: Int, where: Int, condition: Int): Int

  // A comparison with NaN is false.
  protected def isLess(a: Int, b: Int): Int
  protected def isAtMost(a: Int, b: Int): Int
  protected def isEqual(a: Int, b: Int): Int
  protected def not(a: Int): Int
  protected def and(a: Int, b: Int): Int
  protected def or(a: Int, b: Int): Int

  protected def bitsOf(a: Int): Int
  protected def ofBits(a: Int): Int
  protected def bitConstant(value: Int): Int
  protected def addBits(a: Int, b: Int): Int
  protected def andBits(a: Int, b: Int): Int
  protected def orBits(a: Int, b: Int): Int
  protected def xorBits(a: Int, b: Int): Int
  protected def shiftLeft(a: Int, by: Int): Int

  /** The condition that the highest bit is set. */
  protected def isHighest(a: Int): Int

  /** Register or variable of a node's result; generates its code first if needed. */
  protected final def of(node: Node): Int = node.op match
    case Op.Const => constant(node.value.toFloat)
    case _        => slots.getOrElseUpdate(node, computed(node))

  protected final def computed(node: Node): Int =
    slots.getOrElse(
      node, {
        val place = write(node)
        slots(node) = place
        place
      }
    )

  private def write(node: Node): Int =
    def a = of(node.args(0))
    def b = of(node.args(1))
    node.op match
      case Op.Const => constant(node.value.toFloat)
      case Op.Input => input(node.index)
      case Op.Param => parameter(node.index)
      case Op.Neg   => neg(a)
      case Op.Abs   => abs(a)
      case Op.Sqrt  => sqrt(a)
      case Op.Add   =>
        Products.factor(node) match
          case Some(product) if !slots.contains(product) =>
            val other = if node.args(0) == product then node.args(1) else node.args(0)
            fma(of(product.args(0)), of(product.args(1)), of(other))
          case _ => add(a, b)
      case Op.Sub => sub(a, b)
      case Op.Mul => mul(a, b)
      case Op.Div =>
        val by = node.args(1)
        // Exact either way.
        if by.isConst && isPowerOf2(by.value) then mul(a, constant((1 / by.value).toFloat)) else div(a, b)
      case Op.Min   => extreme(node)((limit, value) => isLess(limit, value))
      case Op.Max   => extreme(node)((limit, value) => isLess(value, limit))
      case Op.Where => choose(of(node.args(2)), b, a)
      case Op.Lt    => isLess(a, b)
      case Op.Le    => isAtMost(a, b)
      case Op.Eq    => isEqual(a, b)
      case Op.Not   => not(a)
      case Op.And   => and(a, b)
      case Op.Or    => or(a, b)
      case Op.Sin   => sinCos(node.args(0))._1
      case Op.Cos   => sinCos(node.args(0))._2
      case Op.Atan2 => atan2(a, b, isPositive(node.args(1)))
      case Op.Atan  => atan2(a, constant(1f), isAhead = true)
      case Op.Hypot =>
        val (x, y) = (a, b)
        sqrt(fma(x, x, mul(y, y)))
      case Op.Exp =>
        val x      = a
        val finite = choose(exp(x), constant(Float.PositiveInfinity), isLess(constant(88f), x))
        choose(finite, constant(0f), isLess(x, constant(-87f)))
      case Op.Tanh  => tanh(a)
      case Op.Acos  => acos(node.args(0))
      case Op.Asin  => sub(constant(1.57079633f), acos(node.args(0)))
      case Op.Rint  => rint(a)
      case Op.Floor =>
        val x       = a
        val nearest = rint(x)
        choose(nearest, sub(nearest, constant(1f)), isLess(x, nearest))
      case Op.Ceil =>
        val x       = a
        val nearest = rint(x)
        choose(nearest, add(nearest, constant(1f)), isLess(nearest, x))
      case Op.Signum =>
        val x    = a
        val zero = constant(0f)
        choose(choose(x, constant(-1f), isLess(x, zero)), constant(1f), isLess(zero, x))
      case Op.Remainder =>
        val (x, y) = (a, node.args(1))
        val times  =
          if y.isConst then
            sub(fma(x, constant((1 / y.value).toFloat), constant(Round)), constant(Round))
          else rint(div(x, of(y)))
        if y.isConst then fma(times, constant(-y.value.toFloat), x)
        else fma(neg(times), of(y), x)
      case Op.Always => throw Untraceable("a condition that always holds")

  // Polynomials of Cephes' sinf.c, atanf.c and expf.c; LaneMath has the last one for passes written by hand.

  private def sinCos(of: Node): (Int, Int) = sinesAndCosines.getOrElseUpdate(
    of, {
      val angle    = this.of(of)
      val rounded  = fma(angle, constant(0.63661977f), constant(Round))
      val quarters = sub(rounded, constant(Round))
      val rest     = fma(
        quarters,
        constant(-7.549789948768648e-8f),
        fma(quarters, constant(-4.837512969970703e-4f), fma(quarters, constant(-1.5703125f), angle))
      )
      val square = mul(rest, rest)
      val sin    = fma(
        mul(series(square, -1.9515295891e-4f, 8.3321608736e-3f, -1.6666654611e-1f), square),
        rest,
        rest
      )
      val cos =
        series(square, 2.443315711809948e-5f, -1.388731625493765e-3f, 4.166664568298827e-2f, -0.5f, 1f)
      val quadrant        = bitsOf(rounded)
      val (half, quarter) = (shiftLeft(quadrant, 30), shiftLeft(quadrant, 31))
      val odd             = isHighest(quarter)
      (signed(choose(sin, cos, odd), half), signed(choose(cos, sin, odd), xorBits(half, quarter)))
    }
  )

  /** @param isAhead whether x is known not to be negative */
  private def atan2(y: Int, x: Int, isAhead: Boolean): Int =
    val (ax, ay) = (if isAhead then x else abs(x), abs(y))
    val steep    = isLess(ax, ay)
    val large    = add(choose(ax, ay, steep), constant(1e-30f))
    val small    = choose(ay, ax, steep)
    val beyond   = isLess(mul(large, constant(0.41421356f)), small)
    val ratio    = div(choose(small, sub(small, large), beyond), choose(large, add(large, small), beyond))
    val square   = mul(ratio, ratio)
    val rise     =
      mul(
        series(square, 8.05374449538e-2f, -1.38776856032e-1f, 1.99777106478e-1f, -3.33329491539e-1f),
        square
      )
    val first  = fma(rise, ratio, ratio)
    val second = choose(first, add(first, constant(0.785398163f)), beyond)
    val third  = choose(second, sub(constant(1.57079633f), second), steep)
    val angle  =
      if isAhead then third else choose(third, sub(constant(3.14159265f), third), isLess(x, constant(0f)))
    ofBits(orBits(bitsOf(angle), andBits(bitsOf(y), bitConstant(Int.MinValue))))

  /** The exponential, for arguments from −87 to 88; larger results exceed floats. */
  private def exp(x: Int): Int =
    val rounded = fma(x, constant(1.44269504f), constant(Round))
    val power   = sub(rounded, constant(Round))
    val rest    = fma(power, constant(2.12194440e-4f), fma(power, constant(-0.693359375f), x))
    val tail    = series(
      rest,
      1.9875691500e-4f,
      1.3981999507e-3f,
      8.3334519073e-3f,
      4.1665795894e-2f,
      1.6666665459e-1f,
      5.0000001201e-1f
    )
    val fraction = bitsOf(fma(tail, mul(rest, rest), add(rest, constant(1f))))
    // The bits of a NaN differ between machines, and could become a number by the sum.
    choose(x, ofBits(addBits(fraction, shiftLeft(bitsOf(rounded), 23))), isEqual(x, x))

  private def tanh(x: Int): Int =
    val inside = within(x, constant(-9f), constant(9f))
    val power  = exp(add(inside, inside))
    div(sub(power, constant(1f)), add(power, constant(1f)))

  /** The arc cosine as √(1 − |x|) · polynomial: Abramowitz and Stegun, 4.4.46. Arguments that exceed 1 by
    * rounding count as 1; beyond that, the root is NaN.
    */
  private def acos(of: Node): Int =
    val x     = this.of(of)
    val plain = isPositive(of)
    val one   = constant(1f)
    val whole = if plain then x else abs(x)
    val size  = choose(whole, one, and(isLess(one, whole), isLess(whole, constant(1.000001f))))
    val rise  = series(
      size,
      -0.0012624911f,
      0.0066700901f,
      -0.0170881256f,
      0.0308918810f,
      -0.0501743046f,
      0.0889789874f,
      -0.2145988016f,
      1.5707963050f
    )
    val angle = mul(sqrt(sub(one, size)), rise)
    if plain then angle
    else choose(angle, sub(constant(3.14159265f), angle), isLess(x, constant(0f)))

  private def isPositive(node: Node): Boolean = node.op match
    case Op.Sqrt | Op.Abs | Op.Exp | Op.Hypot => true
    case Op.Const                             => node.value >= 0
    case Op.Min                               => node.args.forall(isPositive)
    case Op.Max                               => node.args.exists(isPositive)
    case _                                    => false

  private def isPowerOf2(value: Double) =
    val exponent = Math.getExponent(value)
    exponent.abs < 32 && Math.scalb(1.0, exponent) == value.abs

  private def rint(x: Int): Int = sub(add(x, constant(Round)), constant(Round))

  /** A polynomial by Horner's rule.
    *
    * @param coefficients the coefficients, that of the highest power first
    */
  private def series(x: Int, coefficients: Float*): Int =
    coefficients.tail.foldLeft(constant(coefficients.head))((sum, each) => fma(sum, x, constant(each)))

  /** The number with its sign changed where the highest bit is set. */
  private def signed(x: Int, bits: Int): Int =
    ofBits(xorBits(bitsOf(x), andBits(bits, bitConstant(Int.MinValue))))

  /** The minimum or maximum, by a comparison. It takes two instructions, a machine's own `min` or `max` up to
    * six. NaN stays NaN if only one of the two arguments can be NaN; that one is then the value.
    *
    * @param isBeyond compares the limit with the value
    */
  private def extreme(node: Node)(isBeyond: (Int, Int) => Int): Int =
    val Vector(a, b)   = node.args
    val (value, limit) =
      if b.isConst || b.op == Op.Param || !isNumber(a) && isNumber(b) then (a, b) else (b, a)
    val (of, most) = (this.of(value), this.of(limit))
    val beyond     = isBeyond(most, of)
    choose(of, most, if isNumber(limit) then beyond else or(beyond, not(isEqual(most, most))))

  private val numbers = mutable.HashMap.empty[Node, Boolean]

  /** Whether a node is never NaN if its inputs are not NaN and no intermediate value overflows. */
  private def isNumber(node: Node): Boolean =
    // Expressions may be deeper than the call stack.
    val asked = mutable.Stack(node)
    while asked.nonEmpty do
      val unknown = asked.top.args.filterNot(numbers.contains)
      if unknown.nonEmpty then asked.pushAll(unknown)
      else
        val known = asked.pop()
        numbers(known) = known.op match
          case Op.Div | Op.Remainder =>
            known.args(1).isConst && !known.args(1).is(0) && numbers(known.args(0))
          case Op.Sqrt           => isPositive(known.args(0)) && numbers(known.args(0))
          case Op.Asin | Op.Acos => false
          case Op.Const          => !known.value.isNaN
          case _                 => known.args.forall(numbers)
    numbers(node)

  private def within(value: Int, least: Int, most: Int): Int =
    val low = choose(value, most, isLess(most, value))
    choose(low, least, isLess(low, least))

private object ExpressionCompiler:
  /** 1.5·2²³: adding it leaves a float's nearest integer in its lowest bits. */
  private val Round = LaneMath.ROUND
