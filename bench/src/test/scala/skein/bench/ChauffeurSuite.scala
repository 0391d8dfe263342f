package skein.bench

class ChauffeurSuite extends munit.FunSuite:
  // chauffeur.c prints 17.219968 for `1 64`; the difference is the order of float operations, or floats'
  // rounding.
  private val blocks = 64
  private val worlds = blocks * ChauffeurKernel.BLOCK

  test("the SIMD kernel simulates the C yardstick's worlds: equal witness for 64 blocks"):
    assertEqualsDouble(ChauffeurKernel().run(0, blocks) / worlds, 17.219968, 0.003)

  test("the scalar form simulates them as well"):
    assertEqualsDouble(ChauffeurScalar.run(0, blocks) / worlds, 17.219968, 0.01)
