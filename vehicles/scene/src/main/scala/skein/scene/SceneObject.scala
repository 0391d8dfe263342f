package skein.scene

import skein.units.Vector3

/** A named object in the world, made of convex parts.
  *
  * @param place placement in the world: north, east, down, m
  * @param id segmentation id, 0 to 255; None: derived from its name
  */
final case class SceneObject(
    name: String,
    parts: Vector[SceneObject.Part],
    place: Placement,
    id: Option[Int] = None
):

  /** The bounding box in its own frame: lowest and highest corner. */
  def bounds: (Vector3, Vector3) =
    val corners = parts.flatMap(part => part.shape.polyhedron._1.map(part.at.outside))
    SceneObject.around(corners)

  private[scene] def solids(item: Int): Vector[Solid] =
    parts.map(part => Solid(item, part.shape, place.outside(part.at), part.rgb))

object SceneObject:
  /** @param at placement in its object's frame
    * @param rgb 0xrrggbb
    */
  final case class Part(shape: Shape, at: Placement, rgb: Int)

  private[scene] def around(corners: Seq[Vector3]): (Vector3, Vector3) = (
    Vector3(corners.map(_.x).min, corners.map(_.y).min, corners.map(_.z).min),
    Vector3(corners.map(_.x).max, corners.map(_.y).max, corners.map(_.z).max)
  )

  private val AtOrigin = Placement(Vector3.Zero)

  def apply(name: String, shape: Shape, place: Placement, rgb: Int, id: Option[Int]): SceneObject =
    SceneObject(name, Vector(Part(shape, AtOrigin, rgb)), place, id)
