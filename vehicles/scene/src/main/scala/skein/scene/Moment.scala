package skein.scene

import skein.units.Vector3

/** Everything that exists at one instant: the scene, and vehicles at their places. Items are numbered: 0 is
  * the ground, then the objects, then the vehicles.
  */
final class Moment(val scene: Scene, val vehicles: IndexedSeq[SceneObject]):

  // Made on first use: hundreds of moments may wait to be drawn.
  private[scene] lazy val solids: Vector[Solid] =
    scene.solids ++ vehicles.zipWithIndex.flatMap((thing, index) => thing.solids(itemOf(index)))

  private[skein] def eachSolid(visit: Solid => Unit): Unit = solids.foreach(visit)

  def itemOf(vehicle: Int): Int = Item.FirstObject + scene.objects.size + vehicle

  def items: Int = itemOf(vehicles.size)

  def name(item: Int): String = thing(item).fold(Scene.Ground)(_.name)

  /** The object or vehicle with this item number; None for the ground. */
  def thing(item: Int): Option[SceneObject] =
    val index = item - Item.FirstObject
    if index < 0 then None
    else if index < scene.objects.size then Some(scene.objects(index))
    else Some(vehicles(index - scene.objects.size))

  /** The bounding boxes of all convex parts, in the world: lowest and highest corner. */
  def bounds: Seq[(Vector3, Vector3)] = solids.map: solid =>
    SceneObject.around(solid.corners.grouped(3).map(c => Vector3(c(0), c(1), c(2))).toSeq)

  /** Whether nothing blocks the line between two points. The ground hides what lies below it.
    *
    * @param except an item that does not block: the observer
    */
  def sees(from: Vector3, to: Vector3, except: Int = Item.Nothing): Boolean =
    val way = to - from
    from.z <= Moment.GroundToleranceM && to.z <= Moment.GroundToleranceM &&
    solids.forall(solid =>
      solid.item == except || solid.hit(from.x, from.y, from.z, way.x, way.y, way.z, 1).isInfinite
    )

object Moment:
  /** Depth up to which a point counts as on the ground, m: positions received as latitude and 32-bit altitude
    * are no more exact.
    */
  val GroundToleranceM = 0.001
