package skein.formula

import skein.signal.SplitMix64
import skein.units.Vector3

/** For every operator, a formula read from a method's bytecode computes the method's result. Methods that are
  * not formulas are refused with a reason.
  */
class FormulaLaws extends munit.FunSuite:
  import FormulaLaws.*

  private val functions: Seq[(String, Seq[Double] => Double)] = Seq(
    "arithmetic"  -> (x => Operators.arithmetic(x(0), x(1))),
    "roots"       -> (x => Operators.roots(x(0), x(1))),
    "circular"    -> (x => Operators.circular(x(0), x(1))),
    "exponential" -> (x => Operators.exponential(x(0), x(1))),
    "rounding"    -> (x => Operators.rounding(x(0), x(1))),
    "comparing"   -> (x => Operators.comparing(x(0), x(1))),
    "counting"    -> (x => Operators.counting(x(0), x(1))),
    "loops"       -> (x => Operators.loops(x(0), x(1))),
    "objects"     -> (x => Operators.objects(x(0), x(1))),
    "chosen"      -> (x => Operators.chosen(x(0), x(1))),
    "early"       -> (x => Operators.early(x(0), x(1)))
  )

  for (name, method) <- functions do
    test(s"$name: the formula has the method's results, to the bit (seed 5)"):
      val random   = SplitMix64(5)
      val formula  = Formula.of(Operators, name).fold(throw _, identity)
      val special  = Vector(0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 1e-300, Double.NaN, Double.PositiveInfinity)
      def number() =
        if random.nextDouble() < 0.3 then special((random.nextDouble() * special.size).toInt)
        else 8 * random.nextDouble() - 4
      for _ <- 1 to 3000 do
        val input = Array(number(), number())
        // All NaNs are one: which of two comes out of a sum is the processor's own.
        assertEquals(
          java.lang.Double.doubleToLongBits(formula.evaluate(input, Array.emptyDoubleArray)(0)),
          java.lang.Double.doubleToLongBits(method(input.toSeq)),
          input.mkString(" ")
        )

  test("equal expressions share one node, and known values are computed immediately"):
    val trace  = Trace()
    val (a, b) = (trace.input(0), trace.input(1))
    assert(trace.add(a, b) eq trace.add(a, b))
    assertEquals(trace.mul(trace.const(3), trace.const(0.1)).value, 3 * 0.1)
    assertEquals(trace.unary(Op.Sin, trace.const(1)).value, StrictMath.sin(1))
    // −0 + 0 is 0, so adding 0 is not nothing.
    assertNotEquals(trace.add(a, trace.const(0)), a)

  test("arguments and results may be case classes and arrays of doubles"):
    val formula = Formula.of(Operators, "middle", Map("weights" -> 3)).fold(throw _, identity)
    assertEquals(formula.inputs.size, 9)
    assertEquals(formula.outputs.map(_._1), Vector("x", "y", "z"))
    val out = formula.evaluate(Array(1, 2, 3, 4, 5, 6, 0.5, 0.25, 2), Array.emptyDoubleArray)
    assertEquals(out.toVector, Vector(1.5, 0.75, 6.0))

  for
    (method, reason) <- Seq(
      "untilSmall" -> "a loop whose end depends on what is observed",
      "index"      -> "an index that depends on what is observed",
      "clock"      -> "it calls java.lang.System.nanoTime",
      "prints"     -> "not arithmetic",
      "counts"     -> "it reads the variable calls",
      "platform"   -> "StrictMath.sin is the same everywhere",
      "refuses"    -> "it throws",
      "remainder"  -> "% on doubles"
    )
  do
    test(s"$method is refused, with its source line"):
      val refused = Formula.of(Refused(), method).fold(identity, _ => fail("it was traced"))
      assert(refused.getMessage.contains(reason), refused.getMessage)
      assert(refused.where.contains("FormulaLaws.scala:"), refused.getMessage)

  test("cases of an enum without fields are different forms"):
    for
      make <- Seq[Turn => AnyRef](Turning(_), TurningWith(_));
      case Vector(one, other) <- Turn.values.toVector.combinations(2)
    do
      val formula = Formula.of(make(one), "turn").fold(throw _, identity)
      assert(formula.fits(make(one)))
      assert(!formula.fits(make(other)), s"$one and $other")

object FormulaLaws:
  enum Turn:
    case Left, Right, Around

  final case class Turning(by: Turn):
    def turn(a: Double): Double = by match
      case Turn.Left   => -a
      case Turn.Right  => a
      case Turn.Around => math.Pi

  final case class TurningWith(by: Turn):
    def turn(a: Double): Double = if by == Turn.Left then -a else if by eq Turn.Right then a else math.Pi

  enum Shape:
    case Round(radius: Double)
    case Square(side: Double)
    case Flat
  import Shape.*

  object Operators:
    def arithmetic(a: Double, b: Double): Double = (a + b) * (a - b) / (b + 3) - -a * 1.0
    def roots(a: Double, b: Double): Double      = math.sqrt(math.abs(a)) + StrictMath.hypot(a, b)
    def circular(a: Double, b: Double): Double   =
      StrictMath.sin(a) + StrictMath.cos(b) * StrictMath.atan2(a, b) - StrictMath.atan(b) +
        StrictMath.asin(a / 4) * StrictMath.acos(b / 4) + math.IEEEremainder(a * 10, 2 * math.Pi)
    def exponential(a: Double, b: Double): Double = StrictMath.exp(a) - StrictMath.tanh(b)
    def rounding(a: Double, b: Double): Double    =
      math.floor(a) + 10 * math.ceil(b) + 100 * math.rint(a * b) + math.signum(a) * math.min(a, b) + a.max(b)
    def comparing(a: Double, b: Double): Double =
      val first = if a < b then 1 else if a == b then 2 else 3
      val both  = if a <= 1 && b >= -1 || !(a > b) then a else b
      val odd   = (a > 0) ^ (b > 0)
      first + both + (if odd != (a != b) then 7 else 0) + (if a.isNaN then 100 else 0)
    def counting(a: Double, b: Double): Double =
      var positive = 0
      if a > 0 then positive += 1
      if b > 0 then positive += 1
      if positive == 2 then a * b else positive - 0.5
    def loops(a: Double, b: Double): Double =
      val values = Array(a, b, a * b)
      var sum    = 0.0
      for i <- values.indices do sum += values(i) * (i + 1)
      var i = 0
      while i < 4 do
        if sum > 1 then sum = sum / 2
        i += 1
      values.foldLeft(sum)(_ + 2 * _)
    def objects(a: Double, b: Double): Double =
      val far    = Vector3(a, b, 1)
      val near   = if a > b then far * 0.5 else Vector3(b, a, 0)
      val (x, y) = (near.x - far.y, near.norm)
      Some(x).map(_ + y).get
    def chosen(a: Double, b: Double): Double =
      val found  = if a > 0 then Some(a) else None
      val shape  = if b > a then Round(b) else if b > 0 then Square(a) else Flat
      val of     = Vector(a, b, a - b)(if a > b then 2 else 0)
      val scaled = shape match
        case Round(radius) => radius * 3
        case Square(side)  => side * side
        case Flat          => -1
      found.getOrElse(b) + scaled + of
    def early(a: Double, b: Double): Double =
      if a < 0 then return b
      if b < 0 then return a
      a * b
    def middle(from: Vector3, to: Vector3, weights: Array[Double]): Vector3 =
      val apart = to - from
      Vector3(apart.x * weights(0), apart.y * weights(1), apart.z * weights(2))

  final class Refused:
    var calls = 0

    def untilSmall(a: Double): Double =
      var x = a
      while x > 1 do x /= 2
      x
    def index(a: Double): Double =
      var above = 0
      for bound <- 0 until 3 do if a > bound then above += 1
      Array(1.0, 2.0, 3.0, 4.0)(above)
    def clock(a: Double): Double  = a * System.nanoTime
    def prints(a: Double): Double =
      println("a")
      a
    def counts(a: Double): Double =
      calls += 1
      a
    def platform(a: Double): Double = math.sin(a)
    def refuses(a: Double): Double  =
      require(a > 0, "a must be positive")
      a
    def remainder(a: Double): Double = a % 3
