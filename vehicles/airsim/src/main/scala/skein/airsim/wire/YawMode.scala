package skein.airsim.wire

/** A yaw (degrees from north) or a yaw rate (degrees per second). Either key may be missing; further keys are
  * skipped.
  */
final private[skein] case class YawMode(is_rate: Boolean = true, yaw_or_rate: Float = 0) derives Fields

private[skein] object YawMode:
  val Still: YawMode = YawMode()
