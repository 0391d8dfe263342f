package skein.simulator

import skein.units.{Quaternion, Vector3}

/** What stands and flies in the simulator's world, as shapes: the ground, and vehicles as boxes. World frame NED, m.
  *
  * @param bodies
  *   the vehicles, by their index
  */
final private[simulator] class Scene(val bodies: Seq[Scene.Body]):
  import Scene.*

  /** Whether nothing stands between two points. The ground hides what lies below it.
    *
    * @param except
    *   a body that does not stand in the way: the one that looks
    */
  def sees(from: Vector3, to: Vector3, except: Option[Int] = None): Boolean =
    from.z <= GroundToleranceM && to.z <= GroundToleranceM &&
      bodies.zipWithIndex.forall((body, index) => except.contains(index) || !body.cuts(from, to))

private[simulator] object Scene:

  /** A vehicle's box.
    *
    * @param centre
    *   world, m
    * @param half
    *   of its lengths to the front, right and down, m
    */
  final case class Body(centre: Vector3, orientation: Quaternion, half: Vector3):

    /** Whether the straight way between two points enters it: by slabs, in its own frame. */
    def cuts(from: Vector3, to: Vector3): Boolean =
      val start = Frames.intoBody(from - centre, orientation)
      val way   = Frames.intoBody(to - from, orientation)
      var enter = 0.0
      var leave = 1.0
      for (s, w, h) <- Seq((start.x, way.x, half.x), (start.y, way.y, half.y), (start.z, way.z, half.z)) do
        if w == 0 then { if math.abs(s) > h then leave = -1.0 }
        else
          enter = math.max(enter, math.min((-h - s) / w, (h - s) / w))
          leave = math.min(leave, math.max((-h - s) / w, (h - s) / w))
      enter <= leave

    /** How far it reaches from its centre at most, m. */
    def reachM: Double = half.norm

  /** What lies no deeper than this lies on the ground: places that come as a latitude and a 32-bit altitude are no better.
    */
  val GroundToleranceM = 0.001
