package skein.simulator

import scala.collection.mutable
import skein.units.{Quaternion, Vector3}

/** The vehicles' cameras: AirSim's and those of the settings, and what clients have made of them.
  *
  * @param equipment
  *   of the settings
  */
final private[simulator] class Cameras(equipment: Equipment):
  private val changed  = mutable.Map.empty[(Int, String), Camera]
  private val detected = mutable.Map.empty[(Int, String, Int), Detection]

  /** A camera's own name, if the vehicle of this name has such a one. */
  def canonical(vehicle: String, name: String): Option[String] =
    val own = Camera.Aliases.getOrElse(name, name)
    Option.when(Camera.Defaults.contains(own) || equipment.cameras.get(vehicle).exists(_.contains(own)))(own)

  /** @param called
    *   the vehicle's name
    */
  def apply(vehicle: Int, called: String, name: String): Camera =
    changed.getOrElse((vehicle, name), initial(called, name))

  private def initial(vehicle: String, name: String): Camera =
    val builtIn = Camera.Defaults.getOrElse(name, Camera(Vector3.Zero, Quaternion.Identity))
    val placed  = equipment.cameras.get(vehicle).flatMap(_.get(name)).flatMap(_.place).fold(builtIn): place =>
      builtIn.copy(position = place.position, orientation = place.orientation)
    val fovDeg = equipment.capture(vehicle, name, imageType = 0).fovDeg
    if fovDeg == Camera.DefaultFovDeg then placed else placed.withFov(fovDeg)

  def update(vehicle: Int, name: String, camera: Camera): Unit = changed((vehicle, name)) = camera

  /** What is looked for in pictures of this kind. */
  def detection(vehicle: Int, name: String, imageType: Int): Detection =
    detected.getOrElse((vehicle, name, imageType), Detection())

  def setDetection(vehicle: Int, name: String, imageType: Int, detection: Detection): Unit =
    detected((vehicle, name, imageType)) = detection

/** What is looked for in pictures.
  *
  * @param meshes
  *   names, which may hold wild cards
  */
final private[simulator] case class Detection(meshes: Set[String] = Set.empty, radiusCm: Float = 20_000)

private[simulator] object Detection:
  val MostMeshes = 1000
