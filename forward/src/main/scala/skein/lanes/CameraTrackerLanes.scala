package skein.lanes

import java.util.Arrays
import skein.formula.Untraceable
import skein.forward.{Duelist, CameraTracker}
import skein.fusion.{SensorFormulas, SensorModel}

/** What a vehicle believes of its opponent by a [[SensorModel]], in many worlds that take the same images at
  * the same times. Compiled from [[SensorFormulas]]; the scalar reference is `skein.forward.CameraTracker`.
  * Mutable.
  */
private[lanes] class CameraTrackerLanes(forms: CameraTrackerLanes.Forms, own: Duelist, opponent: Duelist):
  import CameraTrackerLanes.*
  import TimetableAgents.WORLDS

  private val expose = forms.detected.call
  private val update = forms.joined.call
  private val decide = forms.decidedUpon.call

  private val images         = Array.fill(CameraTracker.Ring)(Array.emptyFloatArray)
  private val validS         = Array.ofDim[Float](CameraTracker.Ring)
  private var newest, before = Array.ofDim[Float](Belief * WORLDS)
  private var replayed       = Array.ofDim[Float](Belief * WORLDS)
  private val ownDown        = everywhere(own.altitudeDownM)
  private val opponentDown   = everywhere(opponent.altitudeDownM)
  private val startX         = everywhere(opponent.startX)
  private val startY         = everywhere(opponent.startY)
  private val bearing, range = Array.ofDim[Float](WORLDS)
  private val nowS, aheadS   = Array.ofDim[Float](WORLDS)
  private val exposedS       = Array.ofDim[Float](WORLDS)

  /** What is decided upon; velocities are the opponent's own. */
  val northM, eastM, northMps, eastMps, ageS: Array[Float] = Array.ofDim[Float](WORLDS)
  val heading: Directions                                  = Directions(WORLDS)

  /** Where the camera looks, rad. */
  protected val axis: Array[Float] = Array.ofDim[Float](WORLDS)

  /** By world, whether an image shows the opponent: 1 or 0. */
  protected def found(image: Int): Array[Float] = Arrays.copyOf(images(image), WORLDS)

  expose.input(0, axis, 0)
  expose.input(3, ownDown, 0)
  expose.input(6, opponentDown, 0)
  expose.input(7, bearing, 0)
  expose.input(8, range, 0)
  update.input(Belief + Detection, exposedS, 0)
  decide.input(Belief, startX, 0)
  decide.input(Belief + 1, startY, 0)
  decide.input(Belief + 2, opponentDown, 0)
  decide.input(Belief + 5, ownDown, 0)
  decide.input(Belief + 6, nowS, 0)
  decide.input(Belief + 7, aheadS, 0)
  for (array, output) <-
      Seq(northM, eastM, northMps, eastMps, heading.cos, heading.sin, ageS, axis).zipWithIndex
  do decide.output(output, array, 0)

  def start(): Unit =
    for state <- Seq(newest, before) do Arrays.fill(state, 0f)
    Arrays.fill(
      axis,
      StrictMath.atan2(opponent.startY - own.startY, opponent.startX - own.startX).toFloat
    )

  /** Takes an image.
    *
    * @param times from `at` on: when; the errors of the bearing and of the range; whether what is in view is
    *   found
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
    expose.input(1, ours.seenX, oursAt)
    expose.input(2, ours.seenY, oursAt)
    expose.input(4, theirs.seenX, theirsAt)
    expose.input(5, theirs.seenY, theirsAt)
    expose.outputs(Detection, images(image), 0)
    expose()
    if times(at + 3) == 0 then Arrays.fill(images(image), 0, WORLDS, 0f)

  /** What an image showed enters the belief.
    *
    * @param isOlder whether it was taken before the one that entered last
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
    Arrays.fill(exposedS, validS(image))
    update.inputs(0, Belief, from, 0)
    update.inputs(Belief, Detection, images(image), 0)
    update.outputs(Belief, into, 0)
    update()

  /** Tells [[northM]] and what follows, and turns the camera there.
    *
    * @param nowS since the start
    * @param aheadS see [[SensorFormulas.decidedUpon]]
    */
  def look(ours: TimetableVehicles, oursAt: Int, nowS: Float, aheadS: Float): Unit =
    Arrays.fill(this.nowS, nowS)
    Arrays.fill(this.aheadS, aheadS)
    decide.inputs(0, Belief, newest, 0)
    decide.input(Belief + 3, ours.seenX, oursAt)
    decide.input(Belief + 4, ours.seenY, oursAt)
    decide()

  private def everywhere(value: Double) = Array.fill(WORLDS)(value.toFloat)

private[lanes] object CameraTrackerLanes:
  /** Numbers of a [[SensorFormulas.Believed]] and of a [[SensorFormulas.Detected]]. */
  private val Belief    = 35
  private val Detection = 13

  /** Below, what floats leave of a covariance is no covariance. */
  private val LeastSd = 2e-4

  /** Compiled. */
  final class Forms(
      val detected: FixedFormula,
      val joined: FixedFormula,
      val decidedUpon: FixedFormula
  )

  /** @return or why this sensor does not fly by lanes
    */
  def of(model: SensorModel): Either[String, Forms] =
    val formulas                        = SensorFormulas(model)
    def form(name: String, inputs: Int) = FixedFormula.of(formulas, name, alike = 0).map: formula =>
      require(formula.inputs.size == inputs, s"$name of ${formula.inputs.mkString(", ")}")
      formula
    if model.bearingSdRad < LeastSd || model.rangeSd < LeastSd then
      Left(s"the lanes know sensors with deviations of $LeastSd rad, and $LeastSd of the range, at least")
    else
      (for
        detected    <- form("detected", 9)
        joined      <- form("joined", Belief + Detection + 1)
        decidedUpon <- form("decidedUpon", Belief + 8)
      yield new Forms(detected, joined, decidedUpon)).left
        .map((why: Untraceable) => s"the sensor is no formula: ${why.getMessage}")
