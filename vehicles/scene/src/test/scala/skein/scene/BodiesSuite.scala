package skein.scene

import skein.units.{Quaternion, Vector3}

class BodiesSuite extends munit.FunSuite:
  private val box =
    Vector(SceneObject.Part(Shape.Box(Vector3(1, 2, 3)), Placement(Vector3(0, 0, 0.5)), 0x102030))
  private val shapes = Vector(Bodies.Shaped("a", box), Bodies.Shaped("b", Vector.empty))
  private val turned = Placement.turned(Vector3(4, 5, -6), 10, 20, 30)
  private val bodies = Bodies(
    shapes,
    Bodies.places(Iterator((turned.position, turned.orientation), (Vector3.Zero, Quaternion.Identity)))
  )

  test("each vehicle is an object of its shape at its place"):
    assertEquals(bodies.map(_.name), Vector("a", "b"))
    assertEquals(bodies(0).place.position, turned.position)
    assertEquals(bodies(0).place.orientation, turned.orientation)
    assertEquals(bodies(1).place.position, Vector3.Zero)
    intercept[IllegalArgumentException](Bodies(shapes, Array.fill(13)(0.0)))

  test("bodies that wait to be drawn store seven numbers a vehicle, and share their shapes"):
    val waiting = Vector.fill(3)(bodies(0).parts)
    assert(waiting.forall(_ eq box))

  test("a moment with bodies equals a moment with their objects"):
    val here  = Moment(Scene.Empty, bodies)
    val there = Moment(
      Scene.Empty,
      Vector(SceneObject("a", box, turned), SceneObject("b", Vector.empty, Placement(Vector3.Zero)))
    )
    assertEquals(here.bounds, there.bounds)
    assertEquals(here.sees(Vector3(0, 5, -6), Vector3(9, 5, -6)), false)
