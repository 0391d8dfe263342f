package skein.simulator

import skein.scene.Scene
import skein.units.*

/** A vehicle's contact with something, in its own frame.
  *
  * @param normal unit normal, away from the object
  * @param pointNed point of contact
  */
final private[simulator] case class Touch(
    at: Instant,
    positionNed: Vector3,
    normal: Vector3,
    depthM: Double,
    pointNed: Vector3,
    name: String
)

private[simulator] object Touch:
  def apply(at: Instant, positionNed: Vector3): Touch =
    Touch(at, positionNed, Vector3(0, 0, -1), 0, positionNed, Scene.Ground)
