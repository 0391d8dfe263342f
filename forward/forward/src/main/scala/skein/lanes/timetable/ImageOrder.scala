package skein.lanes.timetable

import skein.forward.ImageTiming.Ring

/** The order in which a vehicle's images were taken. It is updated when their results become known. Mutable.
  */
private[lanes] final class ImageOrder:
  private val takenNs          = Array.ofDim[Long](Ring)
  private var newest, runnerUp = -1

  /** The image that was taken last among those known before the present one; −1 if there is none. */
  var last = -1

  /** Whether the present image was taken before [[last]]. */
  var isOlder = false

  def start(): Unit =
    newest = -1; runnerUp = -1; last = -1; isOlder = false

  def taken(image: Int, atNs: Long): Unit = takenNs(image % Ring) = atNs

  def known(image: Int): Unit =
    last = newest
    isOlder = whenNs(image) < whenNs(newest)
    // At most two images are being transmitted, and one that is overtaken twice is dropped.
    require(whenNs(image) >= whenNs(runnerUp), s"image $image is older than two others")
    if isOlder then runnerUp = image
    else
      runnerUp = newest
      newest = image

  private def whenNs(image: Int): Long = if image < 0 then Long.MinValue else takenNs(image % Ring)
