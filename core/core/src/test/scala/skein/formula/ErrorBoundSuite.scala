package skein.formula

class ErrorBoundSuite extends munit.FunSuite:
  private val trace    = Trace()
  private val (a, b)   = (trace.input(0), trace.input(1))
  private val quotient = trace.binary(Op.Div, trace.const(1), b)

  private def bound(node: Node, inputs: Array[Double], off: Double) =
    ErrorBound.of(Seq(node), inputs, inputs.map(_ => off), Array.emptyDoubleArray)

  test("the product of zero and an unbounded number is unbounded"):
    val product = trace.mul(a, quotient)
    assertEquals(bound(product, Array(0.0, 1e-3), off = 0.01).error(product), Double.PositiveInfinity)
    assert(bound(product, Array(0.0, 1.0), off = 0.01).error(product) < 0.011)

  test(
    "near a threshold with one unbounded branch, a choice is unbounded, and the threshold is reported " +
      "with its distance"
  ):
    val choice = trace.where(trace.lt(a, b), quotient, trace.neg(quotient))
    val near   = bound(choice, Array(1e-3, 2e-3), off = 0.01)
    assertEquals(near.error(choice), Double.PositiveInfinity)
    assertEquals(near.undecided(Seq(choice)).map((node, by) => (node.op, by)), Vector(Op.Lt -> 1e-3))
    assertEquals(bound(choice, Array(1.0, 2.0), off = 0.01).undecided(Seq(choice)), Vector.empty)
