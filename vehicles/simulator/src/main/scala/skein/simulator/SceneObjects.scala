package skein.simulator

import scala.collection.mutable
import skein.airsim.wire.{Pose, Quaternionr, Vector3r}
import skein.scene.{Bodies, Moment, Placement, Scene, SceneObject, Shape}
import skein.units.Vector3

/** The scene's objects, vehicles and `Ground` by name, with the scales and segmentation ids that clients have
  * set.
  */
final private[simulator] class SceneObjects(world: World):
  import SceneObjects.*

  private val scales = mutable.Map.empty[String, Vector3]
  private val chosen = mutable.Map.empty[String, Int]

  // The scene that the indices belong to: a client's change makes a new one.
  private var seen   = Scene.Empty
  private var places = Map.empty[String, Int]

  private var boxed: (vehicles: Vector[SimulatedVehicle], shapes: Vector[Bodies.Shaped]) =
    (Vector.empty, Vector.empty)

  /** All names, in the order of a [[Moment]]'s item numbers. */
  def names: Seq[String] = Ground +: (world.scene.objects.map(_.name) ++ world.vehicles.map(_.settings.name))

  def exists(name: String): Boolean = name == Ground || thing(name).nonEmpty || vehicle(name).nonEmpty

  /** The index of a scene's object, by its name. */
  def thing(name: String): Option[Int] =
    if seen ne world.scene then
      seen = world.scene
      places = seen.objects.iterator.map(_.name).zipWithIndex.toVector.reverse.toMap
    places.get(name)

  def vehicle(name: String): Option[SimulatedVehicle] = world.vehicles.find(_.settings.name == name)

  def scale(name: String): Option[Vector3] =
    Option.when(exists(name))(scales.getOrElse(name, Vector3(1, 1, 1)))

  /** Sets a scale; false if the object does not exist. */
  def setScale(name: String, scale: Vector3): Boolean =
    val known = exists(name)
    if known then scales(name) = scale
    known

  def id(name: String): Option[Int] = Option.when(exists(name))(idOf(name))

  def ids: Vector[Int] = names.iterator.map(idOf).toVector

  private def idOf(name: String): Int = chosen.getOrElse(
    name,
    thing(name).flatMap(world.scene.objects(_).id).getOrElse(defaultId(name))
  )

  /** Gives the selected objects this segmentation id, at most 255. Returns whether any was selected. A
    * negative id changes nothing here; in AirSim it hides an object from the segmentation image.
    */
  def setId(which: String => Boolean, id: Int): Boolean =
    val found = names.filter(which)
    if id >= 0 then for name <- found do chosen(name) = id.min(LargestId)
    found.nonEmpty

  def moment: Moment = Moment(world.scene, world.bodies(world.now))

  /** The scene at present, for tests whether a line between two points is free: each vehicle is its bounding
    * box, and camera rigs are left out.
    */
  def boxes: Moment =
    if boxed.vehicles ne world.vehicles then boxed = (world.vehicles, world.vehicles.map(box))
    Moment(world.scene, Bodies(boxed.shapes, world.places(world.now)))

  private def box(vehicle: SimulatedVehicle): Bodies.Shaped =
    val whole = SceneObject.Part(Shape.Box(vehicle.halfLengths), Placement(vehicle.middleFrd), 0)
    Bodies.Shaped(vehicle.settings.name, if vehicle.settings.isCamera then Vector.empty else Vector(whole))

  /** Pose in the world; NaN if the object does not exist, as in AirSim. */
  def poseOf(name: String): Pose =
    if name == Ground then Pose(Vector3r.Zero, Quaternionr(1, 0, 0, 0))
    else
      thing(name).map(world.scene.objects).map(pose).orElse(vehicle(name).map(pose)).getOrElse(Nowhere)

  def pose(thing: SceneObject): Pose =
    Pose(thing.place.position, thing.place.orientation)

  def pose(vehicle: SimulatedVehicle): Pose =
    Pose(vehicle.worldPosition(world.now), vehicle.orientation)

private[simulator] object SceneObjects:
  val Ground: String = Scene.Ground

  private val LargestId = 255

  private val Nowhere =
    Pose(Vector3r(Float.NaN, Float.NaN, Float.NaN), Quaternionr(Float.NaN, Float.NaN, Float.NaN, Float.NaN))

  /** AirSim's default id: 5 plus the sum of the letters of the name in lower case, modulo 256
    * (`InitializeObjectStencilID`).
    */
  def defaultId(name: String): Int =
    val lower =
      name.map(letter => if letter >= 'A' && letter <= 'Z' then (letter + 'a' - 'A').toChar else letter)
    (5 + lower.iterator.filter(_ >= 'a').map(_.toInt).sum) % (LargestId + 1)
