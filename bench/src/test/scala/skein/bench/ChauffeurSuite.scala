package skein.bench

class ChauffeurSuite extends munit.FunSuite:

  test("the SIMD kernel flies the same worlds as the C yardstick: its witness for 64 blocks"):
    // chauffeur.c prints 17.219968 for `1 64`; the difference is the order of float operations.
    assertEqualsDouble(ChauffeurBench.ours(1, 64).witness, 17.219968, 0.003)
