package skein.simulator

import skein.airsim.wire.{CollisionInfo, Vector3r}
import skein.scene.{Contact, Placement, Scene}
import skein.units.{Instant, Quaternion, Vector3}

/** Contacts of one vehicle with a scene's objects. It remembers how far the vehicle can move before it can
  * touch anything.
  *
  * @param startNed origin of the vehicle's own frame in the world
  */
final private[simulator] class Obstacles(startNed: Vector3):
  // In this scene the vehicle can touch nothing within this distance from this place.
  private var freeOf = Scene.Empty
  private var freeAt = Vector3.Zero
  private var freeM  = 0.0

  /** @param centre centre of the box around the vehicle, in the world
    * @param half half lengths of the box, m
    * @param orientation the vehicle's orientation; computed only if something is near
    */
  def touched(scene: Scene, centre: Vector3, half: Vector3)(orientation: => Quaternion): Option[Contact] =
    if (scene eq freeOf) && (centre - freeAt).norm < freeM then None
    else
      freeOf = scene
      freeAt = centre
      freeM = Contact.clearanceM(scene, centre, half.norm)
      if freeM <= 0 then Contact.of(scene, Placement(centre, orientation), half) else None

  /** Converts a contact to what clients receive.
    *
    * @param positionNed the vehicle's position, in its own frame
    */
  def told(scene: Scene, contact: Contact, at: Instant, positionNed: Vector3): CollisionInfo = CollisionInfo(
    true,
    contact.depthM.toFloat,
    at,
    Vector3r(contact.normal),
    Vector3r(contact.point - startNed),
    Vector3r(positionNed),
    scene.objects(contact.item - 1).name,
    -1
  )
