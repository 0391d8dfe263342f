package skein.vehicle

import skein.units.Vector3

class WindSuite extends munit.FunSuite:
  private val FootM = 0.3048

  test("gusts have the intensities and scale lengths of MIL-F-8785C"):
    // At 100 ft: σw = 0.1 W20, σu = σw / (0.177 + 0.0823)^0.4, Lu = 100 ft / (0.177 + 0.0823)^1.2.
    val (height, w20) = (100 * FootM, 15.4)
    val sigmaW        = 0.1 * w20
    val sigmaU        = sigmaW / math.pow(0.2593, 0.4)
    val lengthU       = 100 * FootM / math.pow(0.2593, 1.2)
    val along         = WindAlong(Wind(gustsMps = w20), seed = 7)
    val stepM         = 10.0
    val gusts         = Vector.fill(200_000)(along.met(height, Vector3(stepM, 0, 0), dtS = 1))
    def deviation(of: Vector3 => Double) = math.sqrt(gusts.map(g => of(g) * of(g)).sum / gusts.size)
    assertEqualsDouble(deviation(_.x), sigmaU, 0.05 * sigmaU)
    assertEqualsDouble(deviation(_.y), sigmaU, 0.05 * sigmaU)
    assertEqualsDouble(deviation(_.z), sigmaW, 0.05 * sigmaW)
    val together = gusts.zip(gusts.tail).map((a, b) => a.x * b.x).sum / (gusts.size - 1)
    assertEqualsDouble(together / (sigmaU * sigmaU), math.exp(-stepM / lengthU), 0.02)

  test("equal seeds give equal gusts, different seeds different ones"):
    def gusts(seed: Long) =
      val along = WindAlong(Wind(Vector3(3, 0, 0), 7.7), seed)
      Vector.fill(20)(along.met(10, Vector3(5, 0, 0), 0.003))
    assertEquals(gusts(1), gusts(1))
    assertNotEquals(gusts(1), gusts(2))

  test("with shear the wind is as stated at 20 ft, weaker below, stronger above, and zero on the ground"):
    val wind = Wind(Vector3(8, 0, 0), roughnessM = 0.05)
    assertEqualsDouble(wind.steadyAt(Wind.ReferenceM).x, 8, 1e-12)
    assertEqualsDouble(wind.steadyAt(60).x, 8 * math.log(60 / 0.05) / math.log(Wind.ReferenceM / 0.05), 1e-12)
    assertEquals(wind.steadyAt(0.05), Vector3.Zero)
    assertEquals(Wind(Vector3(8, 0, 0)).steadyAt(0), Vector3(8, 0, 0))

  test("the gusts that a hovering vehicle meets in still air change with time"):
    val along = WindAlong(Wind(gustsMps = 7.7), seed = 1)
    val first = along.met(10, Vector3.Zero, 60)
    assert((along.met(10, Vector3.Zero, 600) - first).norm > 0.1)
