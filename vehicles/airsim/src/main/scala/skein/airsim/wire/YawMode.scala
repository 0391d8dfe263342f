package skein.airsim.wire

import upickle.default.ReadWriter
import upickle.implicits.serializeDefaults

/** A yaw (degrees from north) or a yaw rate (degrees per second). Either key may be missing; further keys are
  * skipped.
  */
@serializeDefaults(true)
final private[skein] case class YawMode(is_rate: Boolean = true, yaw_or_rate: Float = 0) derives ReadWriter

private[skein] object YawMode:
  val Still: YawMode = YawMode()
