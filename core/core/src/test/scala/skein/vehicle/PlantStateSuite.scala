package skein.vehicle

private final case class Tilted(seen: PlaneReading, rollRad: Double)

class PlantStateSuite extends munit.FunSuite:

  test("a state becomes components in the order of its fields, and the components become an equal state"):
    val state = Tilted(PlaneReading(0.1 + 0.2, -2, 3, -0.0), 1e-300)
    val told  = PlantState.numbers(state)
    assertEquals(told, Vector(0.1 + 0.2, -2, 3, -0.0, 1e-300))
    assertEquals(PlantState.of(Tilted(PlaneReading(0, 0, 0, 0), 0), told), state)
    assertEquals(PlantState.of(0.0, Vector(7.0)), 7.0)

  test("a state class inside an instance is refused, because its components alone do not determine it"):
    final class Garage:
      final case class Parked(northM: Double)
      val car: Parked = Parked(1)
    val said = intercept[IllegalArgumentException](PlantState.of(Garage().car, Vector(2.0))).getMessage
    assert(said.contains("at the top level or in an object") && said.contains("Parked"), said)

  test("a wrong number of components is refused"):
    for count <- Seq(0, 3, 5) do
      val said = intercept[IllegalArgumentException]:
        PlantState.of(PlaneReading(0, 0, 0, 0), Vector.fill(count)(1.0))
      assert(said.getMessage.contains(s"expected a state of 4 numbers, got $count"), said.getMessage)
