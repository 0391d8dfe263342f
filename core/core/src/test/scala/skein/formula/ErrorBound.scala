package skein.formula

import skein.formula.Op.*

/** Bounds the difference between an expression's value in floats, computed with the polynomials of
  * `skein.simd`, and its value in doubles. A running error analysis: it adds each rounding, and each
  * function's own error.
  *
  * @param values values in doubles; a condition is 1 or 0
  * @param errors the bounds; for a condition 1 if floats may decide differently
  */
final class ErrorBound private (values: Array[Double], errors: Array[Double], margins: Array[Double]):
  def value(of: Node): Double = values(of.id)
  def error(of: Node): Double = errors(of.id)

  /** The discontinuities on which these nodes depend and at which floats may decide differently: comparisons,
    * and jumps of angles, signs and integers. Each has its distance from the threshold.
    */
  def undecided(of: Seq[Node]): Vector[(Node, Double)] =
    Trace.needed(of).filter(node => !margins(node.id).isNaN).map(node => (node, margins(node.id)))

object ErrorBound:
  private val U = 1.0 / (1 << 24)

  /** Absolute errors of the polynomials, which `LaneMathSuite` tests; that of the exponential is relative. */
  private val Sine, ArcTangent = 3e-7
  private val ArcCosine        = 6e-7
  private val Exponential      = 2.5e-7

  /** Difference between a full turn in floats and in doubles. */
  private val Turn = 1.8e-7

  /** Computes the bounds.
    *
    * @param off error of each input before rounding
    * @param sameWay whether floats are assumed to decide like doubles; the error is then that of the branch
    *   taken
    */
  def of(
      nodes: Seq[Node],
      input: Array[Double],
      off: Array[Double],
      parameters: Array[Double],
      sameWay: Boolean = false
  ): ErrorBound =
    val needed  = Trace.needed(nodes)
    val size    = needed.iterator.map(_.id).max + 1
    val values  = Array.ofDim[Double](size)
    val errors  = Array.ofDim[Double](size)
    val margins = Array.fill(size)(Double.NaN)
    Evaluation.compute(needed.toArray, input, parameters, values)
    for node <- needed do
      def a       = values(node.args(0).id)
      def b       = values(node.args(1).id)
      def ea      = errors(node.args(0).id)
      def eb      = errors(node.args(1).id)
      val v       = values(node.id)
      val rounded = if v.isInfinite then 0.0 else U * math.abs(v)

      def jump(margin: Double, within: Double, by: Double, beside: Double) =
        if margin > within then beside
        else
          margins(node.id) = margin
          if sameWay then beside else by + beside

      val error = node.op match
        case Const | Param => rounded
        case Input         => off(node.index) + rounded
        case Always        => 0
        case Neg | Abs     => ea
        case Add | Sub     => ea + eb + rounded + U * (ea + eb)
        case Mul           => (math.abs(a) * eb + math.abs(b) * ea + ea * eb) * (1 + U) + rounded
        case Div           =>
          val least = math.abs(b) - eb
          if least <= 0 then Double.PositiveInfinity else (ea + math.abs(v) * eb) / least * (1 + U) + rounded
        case Sqrt =>
          (if a > ea then ea / (math.sqrt(a) + math.sqrt(a - ea)) else math.sqrt(a + ea)) + rounded
        case Min | Max => math.max(ea, eb)
        case Sin | Cos => ea + Sine
        case Atan      => ea + ArcTangent
        case Atan2     =>
          val least = StrictMath.hypot(a, b) - ea - eb
          if least <= 0 then jump(0, 1, 2 * math.Pi, ArcTangent)
          else
            jump(
              if b < eb then math.abs(a) else Double.PositiveInfinity,
              ea,
              2 * math.Pi,
              (ea + eb) / least + ArcTangent
            )
        case Asin | Acos =>
          val room = 1 - math.abs(a)
          (if room > 2 * ea then ea / math.sqrt(room) else math.sqrt(8 * ea)) + ArcCosine
        case Exp                 => v * (StrictMath.expm1(ea) + Exponential)
        case Tanh                => ea + 4 * Exponential
        case Hypot               => ea + eb + 2 * rounded
        case Floor | Ceil | Rint =>
          val cut = if node.op == Rint then a + 0.5 else a
          jump(math.abs(cut - math.rint(cut)), ea, 1, 0)
        case Remainder =>
          val edge = math.abs(b) / 2 - math.abs(v)
          val e    = ea + (math.abs(a / b) + 1) * (eb max Turn) + U * math.abs(a)
          jump(edge, e, math.abs(b), e)
        case Signum => if ea == 0 then 0 else jump(math.abs(a), ea, 2, 0)
        case Where  =>
          val c = values(node.args(2).id)
          if !sameWay && errors(node.args(0).id) > 0 then
            math.abs(b - c) + math.max(eb, errors(node.args(2).id))
          else if a != 0 then eb
          else errors(node.args(2).id)
        case Lt | Le | Eq =>
          if ea + eb == 0 || node.args(0) == node.args(1) then 0 else jump(math.abs(a - b), ea + eb, 1, 0)
        case Not      => ea
        case And | Or => math.max(ea, eb)
      // Zero times an unbounded value is unbounded.
      errors(node.id) = if error.isNaN then Double.PositiveInfinity else error
    ErrorBound(values, errors, margins)
