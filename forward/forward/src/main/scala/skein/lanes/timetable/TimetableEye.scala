package skein.lanes.timetable

import java.util.Arrays
import skein.forward.{RolloutAgent, ImageTiming}
import skein.lanes.policy.{CameraTrackerLanes, LaneObservation}

/** A camera in many worlds whose images are taken at equal times, which a [[Timetable]] defines. Mutable. */
private[lanes] class TimetableEye(forms: CameraTrackerLanes.Forms, own: RolloutAgent, opponent: RolloutAgent)
    extends CameraTrackerLanes(forms, own, opponent):
  import CameraTrackerLanes.{Belief, Detection}
  import LaneObservation.{X, Y}
  import TimetableAgents.WORLDS

  private val images   = Array.fill(ImageTiming.Ring)(Array.emptyFloatArray)
  private val validS   = Array.ofDim[Float](ImageTiming.Ring)
  private var replayed = Array.ofDim[Float](Belief * WORLDS)

  /** For each world, 1 if an image shows the opponent, else 0. */
  protected def found(image: Int): Array[Float] = Arrays.copyOf(images(image), WORLDS)

  /** Resets to the start of an episode with this number of worlds. */
  def start(worlds: Int): Unit =
    use(worlds)
    forget()

  /** Takes an image.
    *
    * @param times values from index `at` on: the image's time, s; the errors of bearing and range, in
    *   standard deviations; whether an opponent in view is detected
    */
  def expose(
      image: Int,
      ours: TimetableVehicles,
      oursAt: Int,
      theirs: TimetableVehicles,
      theirsAt: Int,
      times: Array[Float],
      at: Int
  ): Unit =
    if images(image).length == 0 then images(image) = Array.ofDim[Float](Detection * WORLDS)
    validS(image) = times(at)
    Arrays.fill(bearing, times(at + 1))
    Arrays.fill(range, times(at + 2))
    detect(ours.seen(X), ours.seen(Y), oursAt, theirs.seen(X), theirs.seen(Y), theirsAt, images(image))
    if times(at + 3) == 0 then Arrays.fill(images(image), 0, WORLDS, 0f)

  /** Updates the estimate with an image.
    *
    * @param isOlder whether it was taken before image `last`, which was added before it
    */
  def join(image: Int, isOlder: Boolean, last: Int): Unit =
    if isOlder then
      step(before, image, replayed)
      step(replayed, last, newest)
      val free = before
      before = replayed
      replayed = free
    else
      val free = before
      before = newest
      newest = free
      step(before, image, newest)

  private def step(from: Array[Float], image: Int, into: Array[Float]): Unit =
    Arrays.fill(takenS, validS(image))
    join(from, images(image), into)

  /** Computes the estimate for a decision, and points the camera at it.
    *
    * @param nowS time of the decision, s since the start
    * @param aheadS see [[skein.fusion.SensorFormulas.decidedUpon]]
    */
  def look(ours: TimetableVehicles, oursAt: Int, nowS: Float, aheadS: Float): Unit =
    Arrays.fill(this.nowS, nowS)
    Arrays.fill(this.aheadS, aheadS)
    decideUpon(ours.seen(X), oursAt, ours.seen(Y), oursAt)
    System.arraycopy(newAxis, 0, axis, 0, WORLDS)
