package skein.lanes.timetable

import skein.forward.ImageTiming.Ring

/** The order in which a vehicle's images were taken, as their results become known. Mutable. */
private[lanes] final class ImageOrder:
  private val takenNs          = Array.ofDim[Long](Ring)
  private var newest, runnerUp = -1

  /** The newest image among those known before; −1 if there was none. */
  var last = -1

  /** Whether the image that became known now was taken before [[last]]. */
  var isOlder = false

  def start(): Unit =
    newest = -1; runnerUp = -1; last = -1; isOlder = false

  def taken(image: Int, atNs: Long): Unit = takenNs(image % Ring) = atNs

  def known(image: Int): Unit =
    last = newest
    isOlder = whenNs(image) < whenNs(newest)
    // Two are on the way at most, and whichever is overtaken twice is dropped.
    require(whenNs(image) >= whenNs(runnerUp), s"image $image is older than two others")
    if isOlder then runnerUp = image
    else
      runnerUp = newest
      newest = image

  private def whenNs(image: Int): Long = if image < 0 then Long.MinValue else takenNs(image % Ring)
