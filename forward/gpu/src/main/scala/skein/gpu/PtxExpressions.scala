package skein.gpu

import skein.formula.{Node, Op}
import skein.simd.{ExpressionCompiler, Products}

/** Generates code for expressions in a kernel; each thread computes its own values. The bits equal those of
  * `skein.simd.LaneCompiler`.
  *
  * @param inputOf register of an input; may generate the code that loads it
  * @param parameterOf register of a parameter
  */
private[skein] final class PtxExpressions private (code: Ptx, inputOf: Int => Int, parameterOf: Int => Int)
    extends ExpressionCompiler:

  private val constants = collection.mutable.HashMap.empty[Int, Int]

  private def write(outputs: Vector[Node]): Vector[Int] =
    for node <- Products(outputs).computed if node.op != Op.Const && node.op != Op.Always do
      computed(node): Unit
    outputs.map(of)

  protected def input(number: Int): Int     = inputOf(number)
  protected def parameter(number: Int): Int = parameterOf(number)
  protected def constant(value: Float): Int =
    constants.getOrElseUpdate(java.lang.Float.floatToRawIntBits(value), code.constant(value))
  protected def neg(a: Int): Int                                        = code.one("neg", a)
  protected def abs(a: Int): Int                                        = code.one("abs", a)
  protected def sqrt(a: Int): Int                                       = code.one("sqrt.rn", a)
  protected def add(a: Int, b: Int): Int                                = code.two("add.rn", a, b)
  protected def sub(a: Int, b: Int): Int                                = code.two("sub.rn", a, b)
  protected def mul(a: Int, b: Int): Int                                = code.two("mul.rn", a, b)
  protected def div(a: Int, b: Int): Int                                = code.two("div.rn", a, b)
  protected def fma(a: Int, b: Int, c: Int): Int                        = code.fma(a, b, c)
  protected def choose(otherwise: Int, where: Int, condition: Int): Int =
    code.choose(condition, where, otherwise)
  protected def isLess(a: Int, b: Int): Int     = code.compare("lt", a, b)
  protected def isAtMost(a: Int, b: Int): Int   = code.compare("le", a, b)
  protected def isEqual(a: Int, b: Int): Int    = code.compare("eq", a, b)
  protected def not(a: Int): Int                = code.not(a)
  protected def and(a: Int, b: Int): Int        = code.conditions("and", a, b)
  protected def or(a: Int, b: Int): Int         = code.conditions("or", a, b)
  protected def bitsOf(a: Int): Int             = code.bitsOf(a)
  protected def ofBits(a: Int): Int             = code.ofBits(a)
  protected def bitConstant(value: Int): Int    = code.whole(value)
  protected def addBits(a: Int, b: Int): Int    = code.wholes("add.s32", a, b)
  protected def andBits(a: Int, b: Int): Int    = code.wholes("and.b32", a, b)
  protected def orBits(a: Int, b: Int): Int     = code.wholes("or.b32", a, b)
  protected def xorBits(a: Int, b: Int): Int    = code.wholes("xor.b32", a, b)
  protected def shiftLeft(a: Int, by: Int): Int = code.wholes("shl.b32", a, by.toString)
  protected def isHighest(a: Int): Int          = code.compareWhole("lt", a, 0)

private[skein] object PtxExpressions:
  /** Generates code for expressions at this point, and returns the registers of their values. */
  def write(code: Ptx, outputs: Vector[Node])(input: Int => Int, parameter: Int => Int): Vector[Int] =
    new PtxExpressions(code, input, parameter).write(outputs)
