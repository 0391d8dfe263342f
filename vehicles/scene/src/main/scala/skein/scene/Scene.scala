package skein.scene

/** A world: flat ground at z = 0 under a sky, and objects. North, east, down, m.
  *
  * @param groundRgb colours are 0xrrggbb
  * @param vehicleTagM side of the AprilTag on every vehicle's front, right, back and left, with the vehicle's
  *   number; 0: none
  */
final case class Scene(
    objects: Vector[SceneObject] = Vector.empty,
    groundRgb: Int = 0x6b7f4f,
    skyRgb: Int = 0xb4d2ee,
    vehicleTagM: Double = 0
):
  private[scene] val solids: Vector[Solid] =
    objects.zipWithIndex.flatMap((thing, index) => thing.solids(Item.FirstObject + index))

  /** A copy of the scene with this object at another place. */
  def moved(index: Int, place: Placement): Scene =
    copy(objects = objects.updated(index, objects(index).copy(place = place)))

object Scene:
  val Empty: Scene = Scene()

  val Ground = "Ground"
