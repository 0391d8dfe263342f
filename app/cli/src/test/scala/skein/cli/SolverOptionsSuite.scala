package skein.cli

class SolverOptionsSuite extends munit.FunSuite:

  test("the virtual twin of a live flight has a solver with the measured latency"):
    val tripsMs = Vector(4.0, 4.0, 4.0, 8.0, 2.0)
    assertEquals(SolverOptions.measured(tripsMs).map(_.text), Some("link:lognormal:4.000ms,0.438"))
    assertEquals(SolverOptions.measured(Vector.empty), None)
