package skein.recognition

import skein.scene.*
import skein.scene.render.*
import skein.signal.SplitMix64
import skein.simulator.MultirotorBody
import skein.units.*
import skein.vehicle.Airframe

/** A camera's image of a quadrotor, with the quadrotor's true position.
  *
  * @param positionFrd position of the quadrotor in the camera's frame, m; None without one
  * @param box bounding box of all its pixels, without occlusion
  * @param visible fraction of its pixels that are not occluded, from 0 to 1
  */
final case class DroneImage(
    bgr: Array[Byte],
    positionFrd: Option[Vector3],
    box: Option[Extent],
    visible: Double
):
  /** Whether a detector should find it: at least three pixels wide, and at most half hidden. */
  def isPlain: Boolean = box.exists(box => box.right - box.left >= 3) && visible >= 0.5

/** Images of quadrotors in the shipped scenes, from any position and attitude: for training the detector, and
  * with other seeds for measuring it.
  */
final class DroneImages(camera: Pinhole, seed: Long):
  private val random   = SplitMix64(seed)
  private val scenes   = Vector("empty", "forest", "street").map(SceneFile.named(_).get)
  private val airframe = Airframe()

  private def among(a: Double, b: Double)  = a + (b - a) * random.nextDouble()
  private def evenly(a: Double, b: Double) = a * StrictMath.exp(random.nextDouble() * StrictMath.log(b / a))
  private def normal(deviation: Double)    =
    deviation * math.sqrt(-2 * StrictMath.log(1 - random.nextDouble())) *
      StrictMath.cos(2 * math.Pi * random.nextDouble())

  /** @param rangesM nearest and farthest, drawn uniformly in the logarithm
    * @param without fraction of images without a quadrotor
    */
  def next(rangesM: (Double, Double) = (1.2, 30), without: Double = 0.15): DroneImage =
    val scene = scenes(random.nextInt(scenes.size))
    val place = Placement.turned(
      Vector3(among(0, 100), among(-28, 28), -evenly(1, 30)),
      normal(8),
      normal(12),
      among(-180, 180)
    )
    val view = View(place, camera.width, camera.height, StrictMath.toDegrees(camera.fieldOfView.value))
    if random.nextDouble() < without then
      DroneImage(drawn(Moment(scene, Vector.empty), view), None, None, 0)
    else
      val f     = camera.focalPx
      val right = among(-0.5, 0.5) * camera.width / f
      val down  = among(-0.5, 0.5) * camera.height / f
      val away  = Vector3(1, right, down)
      val range = evenly(rangesM(0), rangesM(1))
      val at    = away * (range / away.norm)
      val ned   = place.outside(at)
      if ned.z > -0.3 then next(rangesM, 0) // below the ground
      else
        val turned = Placement.turned(ned, normal(10), normal(10), among(-180, 180))
        val body   = SceneObject("Drone", MultirotorBody.parts(airframe, 0, 0), turned)
        val moment = Moment(scene, Vector(body))
        val alone  = Moment(Scene.Empty, Vector(body))
        val whole  = extent(alone, view)
        val seen   = extent(moment, view)
        DroneImage(
          drawn(moment, view),
          Some(at),
          whole,
          (for a <- whole; b <- seen yield area(b) / area(a)).getOrElse(0)
        )

  private def extent(moment: Moment, view: View) =
    Renderer.extents(moment, view).find(_.item == moment.itemOf(0))

  private def area(extent: Extent) = (extent.right - extent.left).toDouble * (extent.bottom - extent.top)

  private def drawn(moment: Moment, view: View): Array[Byte] =
    Renderer.draw(moment, view, Set(Kind.Scene), identity)(Kind.Scene) match
      case Raster.Bytes(bgr) => bgr
      case other             => throw IllegalStateException(s"no colours: $other")
