package skein.formula

/** The operation of a [[Trace]]'s node. Some nodes are conditions: those of the last group, and the first
  * argument of [[Op.Where]].
  */
enum Op:
  // Leaves.
  case Const, Input, Param
  case Neg, Abs, Sqrt, Sin, Cos, Asin, Acos, Atan, Exp, Tanh, Floor, Ceil, Rint, Signum
  case Add, Sub, Mul, Div, Min, Max, Atan2, Hypot, Remainder

  /** The second argument if the first one, a condition, holds; else the third. */
  case Where
  // Conditions; a comparison with a NaN does not hold.
  case Lt, Le, Eq, Not, And, Or, Always

  def isLeaf: Boolean = this match
    case Const | Input | Param | Always => true
    case _                              => false

  def isCondition: Boolean = ordinal >= Op.Lt.ordinal

  /** Whether the operation costs far more than an addition. */
  def isDear: Boolean = this match
    case Sin | Cos | Asin | Acos | Atan | Exp | Tanh | Atan2 | Hypot | Remainder | Sqrt | Div => true
    case _                                                                                    => false

object Op:
  /** Evaluates an operation on one number, bit-identically on every JVM. */
  def compute(op: Op, a: Double): Double = op match
    case Neg    => -a
    case Abs    => Math.abs(a)
    case Sqrt   => Math.sqrt(a)
    case Sin    => StrictMath.sin(a)
    case Cos    => StrictMath.cos(a)
    case Asin   => StrictMath.asin(a)
    case Acos   => StrictMath.acos(a)
    case Atan   => StrictMath.atan(a)
    case Exp    => StrictMath.exp(a)
    case Tanh   => StrictMath.tanh(a)
    case Floor  => Math.floor(a)
    case Ceil   => Math.ceil(a)
    case Rint   => Math.rint(a)
    case Signum => Math.signum(a)
    case _      => throw IllegalArgumentException(s"$op takes not one number")

  /** Evaluates an operation on two numbers, bit-identically on every JVM. */
  def compute(op: Op, a: Double, b: Double): Double = op match
    case Add       => a + b
    case Sub       => a - b
    case Mul       => a * b
    case Div       => a / b
    case Min       => Math.min(a, b)
    case Max       => Math.max(a, b)
    case Atan2     => StrictMath.atan2(a, b)
    case Hypot     => StrictMath.hypot(a, b)
    case Remainder => StrictMath.IEEEremainder(a, b)
    case _         => throw IllegalArgumentException(s"$op takes not two numbers")

  /** The truth of a comparison of two numbers, by its operation. */
  def holds(op: Op, a: Double, b: Double): Boolean = op match
    case Lt => a < b
    case Le => a <= b
    case Eq => a == b
    case _  => throw IllegalArgumentException(s"$op compares no numbers")
