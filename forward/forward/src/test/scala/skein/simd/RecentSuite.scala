package skein.simd

import skein.formula.Trace

class RecentSuite extends munit.FunSuite:
  test("if new keys keep coming, recently used ones are kept, and the others are made again"):
    var made             = 0
    val recent           = Recent[Int, String](10)
    def get(number: Int) = recent.getOrMake(number):
      made += 1
      s"value $number"
    for number <- 1 to 1000 do
      get(number): Unit
      assertEquals(get(1), "value 1")
    assertEquals(made, 1000)
    assertEquals(get(995), "value 995")
    assertEquals(made, 1000)
    assertEquals(get(900), "value 900")
    assertEquals(made, 1001)

  test("equal expressions are compiled once, even if other expressions lie between them"):
    def function(number: Int) =
      val trace = Trace()
      BoundFunction.of(Vector(trace.add(trace.input(0), trace.const(number)))).function
    val first = Vector.tabulate(50)(function)
    for number <- first.indices do assert(function(number) eq first(number), number)
