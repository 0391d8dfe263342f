package skein.recognition

import java.nio.ByteBuffer
import skein.fusion.PolarMeasurement
import skein.scenario.Recogniser
import skein.units.*

/** Detects a vehicle by the AprilTags on its four sides, as on the built-in simulator's vehicles: the
  * vehicle's centre lies [[behindM]] behind each tag. If two tags are visible, the mean of their estimates is
  * used.
  *
  * @param id the ID that the vehicle's tags share
  */
final class VehicleTags(camera: Pinhole, id: Long, size: Metres) extends Recogniser:
  private val tags    = AprilTags(camera, size)
  private val behindM = size.value * VehicleTags.BehindSides

  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Option[PolarMeasurement]] =
    tags.find(width, height, bgr).map: found =>
      val own = found.filter(_.id == id)
      Option.when(own.nonEmpty):
        val middles = own.map(tag => tag.positionFrd - tag.facingFrd * behindM)
        val middle  = middles.reduce(_ + _) * (1.0 / middles.size)
        PolarMeasurement.of(middle, own.minBy(_.positionFrd.norm).polar.deviation)

object VehicleTags:
  /** Distance from a side's tag to the vehicle's middle, in sides of a tag: plates of 10 cells form a cube,
    * tags have 8 cells.
    */
  private val BehindSides = 5.0 / 8
