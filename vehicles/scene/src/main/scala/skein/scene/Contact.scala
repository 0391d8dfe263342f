package skein.scene

import skein.units.Vector3

/** The contact of a body with a scene's object.
  *
  * @param normal unit normal, away from the object
  * @param depthM distance along it that ends the contact
  * @param point the point of the body's surface that is deepest within the object
  */
final case class Contact(item: Int, normal: Vector3, depthM: Double, point: Vector3)

object Contact:

  /** The deepest contact of a box with a scene's objects, without the ground. Computed by separating axes:
    * the faces' normals of both, not the edges' products, so that a box counts as touching a little before
    * its edge meets another edge.
    *
    * @param half half lengths of the box, m
    */
  def of(scene: Scene, box: Placement, half: Vector3): Option[Contact] =
    scene.solids.iterator.flatMap(touch(_, box, half)).maxByOption(_.depthM)

  /** A lower bound on the distance that a body can move before it touches anything: from its centre to the
    * nearest object, less `reachM`, its radius.
    */
  def clearanceM(scene: Scene, centre: Vector3, reachM: Double): Double =
    scene.solids.iterator.map(solid => (solid.centre - centre).norm - solid.reachM - reachM)
      .minOption.getOrElse(Double.PositiveInfinity)

  private def touch(solid: Solid, box: Placement, half: Vector3): Option[Contact] =
    var least = Double.PositiveInfinity
    var away  = Vector3.Zero

    def consider(normal: Vector3, depth: Double): Unit =
      if depth < least then
        least = depth
        away = normal

    if (solid.centre - box.position).norm < solid.reachM + half.norm then
      for face <- solid.faces do
        val n     = Vector3(face.nx, face.ny, face.nz)
        val reach = math.abs(n.dot(box.front)) * half.x + math.abs(n.dot(box.right)) * half.y +
          math.abs(n.dot(box.down)) * half.z
        consider(n, face.d - n.dot(box.position) + reach)
      for (axis, length) <- Seq(box.front -> half.x, box.right -> half.y, box.down -> half.z) do
        val along =
          solid.corners.grouped(3).map(c => axis.dot(Vector3(c(0), c(1), c(2)) - box.position)).toArray
        consider(axis, along.max + length)
        consider(axis * -1, length - along.min)
    Option.when(least > 0 && least.isFinite)(Contact(solid.item, away, least, deepest(box, half, away)))

  /** The box's corner that is farthest against the normal; the middle of an edge or face that is equally far.
    */
  private def deepest(box: Placement, half: Vector3, normal: Vector3): Vector3 =
    def reach(axis: Vector3, length: Double) =
      val cosine = normal.dot(axis)
      if math.abs(cosine) < 1e-6 then Vector3.Zero else axis * (-math.signum(cosine) * length)
    box.position + reach(box.front, half.x) + reach(box.right, half.y) + reach(box.down, half.z)
