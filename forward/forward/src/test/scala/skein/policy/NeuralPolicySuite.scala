package skein.policy

import skein.signal.SplitMix64

class NeuralPolicySuite extends munit.FunSuite:

  test("a network by hand: one hidden neuron"):
    // tanh(2·tanh(0.5·ahead − 1·right + 0.1) − 0.3), turned by up to 2 rad/s.
    val policy = NeuralPolicy(NeuralShape(Vector(1)), Vector(0.5, -1, 0, 0, 0.1, 2, -0.3), 2)
    // Facing east, an opponent 10 m east and 4 m north is 10 m ahead and 4 m to the left.
    val hidden = math.tanh(0.5 * 10 / 20 + 4.0 / 20 + 0.1)
    val rate   = policy.turnRate(4, 10, 0, 0, math.Pi / 2)
    assertEqualsDouble(rate, 2 * math.tanh(2 * hidden - 0.3), 1e-12)

  test("a network sees velocities in its own frame too, and turns with its surroundings"):
    val shape    = NeuralShape(Vector(5, 3))
    val source   = SplitMix64(2)
    val policy   = NeuralPolicy(shape, Vector.fill(shape.parameters)(2 * source.nextDouble() - 1))
    val (c, s)   = (math.cos(0.9), math.sin(0.9))
    val straight = policy.turnRate(12, -5, 3, -4, 0.2)
    val rotated  = policy.turnRate(12 * c + 5 * s, 12 * s - 5 * c, 3 * c + 4 * s, 3 * s - 4 * c, 1.1)
    assertEqualsDouble(rotated, straight, 1e-12)

  test("shapes are parsed, count their parameters and name them"):
    val shape = NeuralShape.parse("8x6").fold(fail(_), identity)
    assertEquals(shape.widths, Vector(4, 8, 6, 1))
    assertEquals(shape.parameters, 8 * 5 + 6 * 9 + 7)
    assertEquals(shape.names.size, shape.parameters)
    assertEquals(shape.names.distinct.size, shape.parameters)
    assert(NeuralShape.parse("8x").isLeft && NeuralShape.parse("0").isLeft && NeuralShape.parse("999").isLeft)

  test("a family of networks is found by its shape and makes networks of it"):
    val family = PolicyFamily.parse("neural:8x8").fold(fail(_), identity)
    assertEquals(family.name, "neural:8x8")
    assertEquals(family.space.dimension, NeuralShape(Vector(8, 8)).parameters + 1)
    assertEquals(family.defaultPolicy.asInstanceOf[NeuralPolicy].heading(5, 5, 0, 0, 0.3, 0, 0.1), 0.3)
