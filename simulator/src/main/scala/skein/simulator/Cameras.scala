package skein.simulator

import scala.collection.mutable

/** What clients have made of the vehicles' cameras, by vehicle and camera. */
final private[simulator] class Cameras:
  private val changed  = mutable.Map.empty[(Int, String), Camera]
  private val detected = mutable.Map.empty[(Int, String, Int), Detection]

  def apply(vehicle: Int, name: String): Camera = changed.getOrElse((vehicle, name), Camera.Defaults(name))

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
