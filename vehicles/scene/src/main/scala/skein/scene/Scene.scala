package skein.scene

/** What stands in a world: flat ground at z = 0 under a sky, and objects. North, east, down, m.
  *
  * @param groundRgb colours are 0xrrggbb
  * @param vehicleTagM side of the AprilTag that every vehicle bears on its front, right, back and left, with
  *   the number of its place among the vehicles; 0: none
  */
final case class Scene(
    objects: Vector[SceneObject] = Vector.empty,
    groundRgb: Int = 0x6b7f4f,
    skyRgb: Int = 0xb4d2ee,
    vehicleTagM: Double = 0
):
  private[scene] val solids: Vector[Solid] =
    objects.zipWithIndex.flatMap((thing, index) => thing.solids(Item.FirstObject + index))

  /** The same with this object elsewhere. */
  def moved(index: Int, place: Placement): Scene =
    copy(objects = objects.updated(index, objects(index).copy(place = place)))

object Scene:
  /** Ground, sky, and nothing else. */
  val Empty: Scene = Scene()

  /** The ground's name. */
  val Ground = "Ground"
