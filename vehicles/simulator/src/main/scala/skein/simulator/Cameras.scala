package skein.simulator

import scala.collection.mutable
import skein.units.{Quaternion, Vector3}

/** The vehicles' cameras: AirSim's and those of the settings, as clients have changed them.
  *
  * @param equipment the cameras of the settings
  */
final private[simulator] class Cameras(equipment: SensorSettings):
  private val changed  = mutable.Map.empty[(Int, String), Camera]
  private val detected = mutable.Map.empty[(Int, String, Int), DetectionFilter]

  /** A camera's own name, if the vehicle has it. */
  def canonical(vehicle: SimulatedVehicle, name: String): Option[String] =
    val own    = vehicle.cameras.aliases.getOrElse(name, name)
    val called = vehicle.settings.name
    Option.when(
      vehicle.cameras.places.contains(own) || equipment.cameras.get(called).exists(_.contains(own))
    )(own)

  /** @param index the vehicle's index */
  def apply(index: Int, vehicle: SimulatedVehicle, name: String): Camera =
    changed.getOrElse((index, name), initial(vehicle, name))

  private def initial(vehicle: SimulatedVehicle, name: String): Camera =
    val called  = vehicle.settings.name
    val builtIn = vehicle.cameras.places.getOrElse(name, Camera(Vector3.Zero, Quaternion.Identity))
    val placed  = equipment.cameras.get(called).flatMap(_.get(name)).flatMap(_.place).fold(builtIn): place =>
      builtIn.copy(position = place.position, orientation = place.orientation)
    val fovDeg = equipment.capture(called, name, imageType = 0).fovDeg
    if fovDeg == Camera.DefaultFovDeg then placed else placed.withFov(fovDeg).copy(isZoomed = false)

  def update(vehicle: Int, name: String, camera: Camera): Unit = changed((vehicle, name)) = camera

  /** The filter of objects to detect in images of this kind. */
  def detection(vehicle: Int, name: String, imageType: Int): DetectionFilter =
    detected.getOrElse((vehicle, name, imageType), DetectionFilter())

  def setDetection(vehicle: Int, name: String, imageType: Int, detection: DetectionFilter): Unit =
    detected((vehicle, name, imageType)) = detection

/** Selects the objects that a camera detects.
  *
  * @param meshes names, which may contain wild cards
  */
final private[simulator] case class DetectionFilter(meshes: Set[String] = Set.empty, radiusCm: Float = 20_000)

private[simulator] object DetectionFilter:
  val MostMeshes  = 100
  val LongestName = 100
