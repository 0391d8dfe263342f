package skein.simulator

import scala.collection.mutable
import skein.airsim.wire.{Pose, Quaternionr, Vector3r}
import skein.units.Vector3

/** The objects of the scene under their names, which are those of the vehicles and `Ground`, and what clients have set
  * of them: scales and segmentation ids.
  */
final private[simulator] class SceneObjects(world: World):
  import SceneObjects.*

  private val scales = mutable.Map.empty[String, Vector3]
  private val ids    = mutable.Map.empty[String, Int]

  def names: Seq[String] = Ground +: world.vehicles.map(_.settings.name)

  def exists(name: String): Boolean = name == Ground || vehicle(name).nonEmpty

  def vehicle(name: String): Option[SimulatedVehicle] = world.vehicles.find(_.settings.name == name)

  def scale(name: String): Option[Vector3] =
    Option.when(exists(name))(scales.getOrElse(name, Vector3(1, 1, 1)))

  /** False: there is no such object. */
  def setScale(name: String, scale: Vector3): Boolean =
    val known = exists(name)
    if known then scales(name) = scale
    known

  /** Its segmentation id. */
  def id(name: String): Option[Int] = Option.when(exists(name))(ids.getOrElse(name, defaultId(name)))

  /** Gives these objects this id, at most 255; whether there was one. A negative id only hides an object from the picture
    * of segmentation in AirSim, and changes nothing here.
    */
  def setId(which: String => Boolean, id: Int): Boolean =
    val found = names.filter(which)
    if id >= 0 then for name <- found do ids(name) = id.min(LargestId)
    found.nonEmpty

  /** The shapes as they are now. */
  def scene: Scene = Scene(world.vehicles.map: vehicle =>
    Scene.Body(vehicle.worldPosition(world.now), vehicle.state.orientation, vehicle.halfLengths))

  def pose(vehicle: SimulatedVehicle): Pose =
    Pose(Vector3r(vehicle.worldPosition(world.now)), Quaternionr(vehicle.state.orientation))

private[simulator] object SceneObjects:
  val Ground = "Ground"

  private val LargestId = 255

  /** AirSim's: 5 and the sum of the letters of the name in lower case, modulo 256 (`InitializeObjectStencilID`). */
  def defaultId(name: String): Int =
    val lower =
      name.map(letter => if letter >= 'A' && letter <= 'Z' then (letter + 'a' - 'A').toChar else letter)
    (5 + lower.iterator.filter(_ >= 'a').map(_.toInt).sum) % (LargestId + 1)
