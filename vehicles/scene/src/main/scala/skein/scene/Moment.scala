package skein.scene

import skein.units.Vector3

/** Everything that is there at one instant: the scene, and vehicles where they are. Its items are counted: 0
  * is the ground, then come the objects, then the vehicles.
  */
final class Moment(val scene: Scene, val vehicles: IndexedSeq[SceneObject]):

  private[scene] val solids: Vector[Solid] =
    scene.solids ++ vehicles.zipWithIndex.flatMap((thing, index) => thing.solids(itemOf(index)))

  private[skein] def eachSolid(visit: Solid => Unit): Unit = solids.foreach(visit)

  /** The item that a vehicle is. */
  def itemOf(vehicle: Int): Int = Item.FirstObject + scene.objects.size + vehicle

  def items: Int = itemOf(vehicles.size)

  def name(item: Int): String = thing(item).fold(Scene.Ground)(_.name)

  /** None: the ground. */
  def thing(item: Int): Option[SceneObject] =
    val index = item - Item.FirstObject
    if index < 0 then None
    else if index < scene.objects.size then Some(scene.objects(index))
    else Some(vehicles(index - scene.objects.size))

  /** The least boxes around all convex parts, in the world: the lowest corner and the highest. */
  def bounds: Seq[(Vector3, Vector3)] = solids.map: solid =>
    SceneObject.around(solid.corners.grouped(3).map(c => Vector3(c(0), c(1), c(2))).toSeq)

  /** Whether nothing stands between two points. The ground hides what lies below it.
    *
    * @param except an item that does not stand in the way: the one that looks
    */
  def sees(from: Vector3, to: Vector3, except: Int = Item.Nothing): Boolean =
    val way = to - from
    from.z <= Moment.GroundToleranceM && to.z <= Moment.GroundToleranceM &&
    solids.forall(solid =>
      solid.item == except || solid.hit(from.x, from.y, from.z, way.x, way.y, way.z, 1).isInfinite
    )

object Moment:
  /** What lies no deeper than this lies on the ground: places that come as a latitude and a 32-bit altitude
    * are no better, m.
    */
  val GroundToleranceM = 0.001
