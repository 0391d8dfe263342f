package skein.formula

class TraceSuite extends munit.FunSuite:
  private val trace                                        = Trace()
  private val x                                            = trace.input(0)
  private def within(a: Node, least: Double, most: Double) =
    trace.binary(Op.Min, trace.binary(Op.Max, a, trace.const(least)), trace.const(most))

  test("limits that a number already satisfies are omitted"):
    val once   = within(x, -1, 1)
    val chosen = trace.where(trace.lt(x, trace.const(0)), trace.const(0.5), once)
    for number <- Seq(once, chosen); most <- Seq(1.0, 2.0) do
      assertEquals(within(number, -most, most), number)

  test("limits that may change a number are kept, also the sign of a zero"):
    val once = within(x, -1, 1)
    assertNotEquals(within(once, -1, 0.5), once)
    assertNotEquals(within(once, -0.5, 1), once)
    val negative = within(x, -0.0, 1)
    assertNotEquals(within(negative, 0.0, 1), negative)
