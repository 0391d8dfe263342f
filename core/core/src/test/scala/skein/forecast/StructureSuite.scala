package skein.forecast

import skein.policy.{Axis, SearchSpace}
import skein.scenario.Scenarios
import skein.vehicle.ReducedModel

class StructureSuite extends munit.FunSuite:
  private def structure(label: String, axes: Axis*) =
    Structure(label, SearchSpace(axes.toVector), values => ReducedModel.lag(1, values.head, 0))

  private def refused(make: => Any): String = intercept[IllegalArgumentException](make).getMessage

  test(
    "a structure refuses defaults outside their bounds, reversed bounds, and names that a model file " +
      "cannot contain"
  ):
    assert(refused(Axis(
      "lag-s",
      0.1,
      2,
      3
    )).contains("axis lag-s: the default 3.0 must lie between 0.1 and 2.0"))
    assert(refused(Axis(
      "lag-s",
      2,
      0.1,
      1
    )).contains("axis lag-s: the least value 2.0 must be below the most"))
    assert(refused(Axis("lag-s", 0.1, Double.NaN, 1)).contains("axis lag-s"))
    assert(refused(structure("slow one", Axis("lag-s", 0.1, 2, 1))).contains("got 'slow one'"))
    assert(refused(structure("slow", Axis("lag.s", 0.1, 2, 1))).contains("structure slow: expected letters"))

  test("a structure creates a plant only from one value per parameter"):
    assertEquals(Structure.Drag.plant(Vector(1, 2, 0.1, 0.01)), ReducedModel(1, 2, 0.1, 2, 0.01))
    assert(refused(Structure.Drag.plant(Vector(1, 2))).contains("structure drag: expected 4 values, got 2"))

  test("a program's own structures are found in addition to Skein's, and labels must differ"):
    def program(label: String) =
      Scenarios(Scenarios.ours.kinds, ownStructures = Vector(structure(label, Axis("lag-s", 0.1, 2, 1))))
    assertEquals(program("slow").structure("slow").map(_.label), Right("slow"))
    assertEquals(
      program("slow").structure("fast").left.toOption,
      Some("expected a structure (lag, turn, drag, drag-and-turn, slow), got 'fast'")
    )
    assert(refused(program("drag")).contains("every structure needs a label of its own"))
