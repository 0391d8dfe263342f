package skein.scene

import skein.units.{Quaternion, Vector3}

/** Vehicles at their places at one instant, as objects. It stores [[Bodies.Numbers]] values for each vehicle
  * and makes an object only when one is read, because every image that waits to be drawn holds such a
  * sequence.
  *
  * @param shapes the shape of each vehicle
  * @param places position and orientation of each vehicle: north, east, down, m, then w, x, y, z
  */
final class Bodies(shapes: IndexedSeq[Bodies.Shaped], places: Array[Double]) extends IndexedSeq[SceneObject]:
  require(
    places.length == shapes.length * Bodies.Numbers,
    s"${shapes.length} vehicles, ${places.length} numbers"
  )

  def length: Int = shapes.length

  def apply(vehicle: Int): SceneObject =
    val shape = shapes(vehicle)
    val first = vehicle * Bodies.Numbers
    SceneObject(
      shape.name,
      shape.parts,
      Placement(
        Vector3(places(first), places(first + 1), places(first + 2)),
        Quaternion(places(first + 3), places(first + 4), places(first + 5), places(first + 6))
      )
    )

object Bodies:
  /** The common part of all bodies of one vehicle: its name, and its parts in its own frame. */
  final case class Shaped(name: String, parts: Vector[SceneObject.Part])

  val Numbers = 7

  /** Packs places of vehicles as a body holds them, [[Numbers]] each. */
  def places(all: Iterator[(position: Vector3, orientation: Quaternion)]): Array[Double] =
    all.flatMap(at =>
      val (p, q) = (at.position, at.orientation)
      Iterator(p.x, p.y, p.z, q.w, q.x, q.y, q.z)
    ).toArray
