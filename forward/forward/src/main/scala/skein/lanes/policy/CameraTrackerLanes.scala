package skein.lanes.policy

import java.util.Arrays
import skein.formula.Untraceable
import skein.forward.RolloutAgent
import skein.fusion.{SensorFormulas, SensorModel}
import skein.simd.FixedFormula

/** A vehicle's estimate of its opponent from a camera with this [[SensorModel]], in many worlds. Compiled
  * from [[SensorFormulas]]; the scalar reference is `skein.forward.CameraTracker`. Subclasses decide when
  * images are taken and when they update the estimate: [[skein.lanes.timetable.TimetableEye]] at equal times
  * in all worlds, [[skein.lanes.loop.LoopEye]] at different times. Mutable.
  */
private[lanes] abstract class CameraTrackerLanes(
    forms: CameraTrackerLanes.Forms,
    own: RolloutAgent,
    opponent: RolloutAgent
):
  import CameraTrackerLanes.*

  private val detected     = forms.detected.call
  private val joined       = forms.joined.call
  private val decided      = forms.decidedUpon.call
  private val ownDown      = everywhere(own.altitudeDownM)
  private val opponentDown = everywhere(opponent.altitudeDownM)
  private val startX       = everywhere(opponent.startX)
  private val startY       = everywhere(opponent.startY)
  private val startAxis    =
    StrictMath.atan2(opponent.startY - own.startY, opponent.startX - own.startX).toFloat

  /** The present estimate, and the estimate before the newest image. */
  protected var newest, before: Array[Float] = Array.ofDim(Belief * WORLDS)

  protected val bearing, range: Array[Float] = Array.ofDim[Float](WORLDS)

  /** Time at which the image that updates the estimate was taken, s since the start. */
  protected val takenS: Array[Float] = Array.ofDim[Float](WORLDS)

  /** Time of the decision, s since the start; and the parameter `aheadS` of [[SensorFormulas.decidedUpon]].
    */
  protected val nowS, aheadS: Array[Float] = Array.ofDim[Float](WORLDS)

  /** Direction of the camera now, and after the decision, rad. */
  protected val axis, newAxis: Array[Float] = Array.ofDim[Float](WORLDS)

  /** Results for the decision: the opponent's position and velocity, and the age of the estimate. */
  val northM, eastM, northMps, eastMps, ageS: Array[Float] = Array.ofDim[Float](WORLDS)
  val heading: Directions                                  = Directions(WORLDS)

  detected.input(0, axis, 0)
  detected.input(3, ownDown, 0)
  detected.input(6, opponentDown, 0)
  detected.input(7, bearing, 0)
  detected.input(8, range, 0)
  joined.input(Belief + Detection, takenS, 0)
  decided.input(Belief, startX, 0)
  decided.input(Belief + 1, startY, 0)
  decided.input(Belief + 2, opponentDown, 0)
  decided.input(Belief + 5, ownDown, 0)
  decided.input(Belief + 6, nowS, 0)
  decided.input(Belief + 7, aheadS, 0)
  for (array, output) <-
      Seq(northM, eastM, northMps, eastMps, heading.cos, heading.sin, ageS, newAxis).zipWithIndex
  do decided.output(output, array, 0)

  /** Limits the simulation to the first worlds, until the next call. */
  protected def use(worlds: Int): Unit = for call <- Seq(detected, joined, decided) do call.use(worlds)

  protected def forget(): Unit =
    for state <- Seq(newest, before) do Arrays.fill(state, 0f)
    Arrays.fill(axis, startAxis)

  /** Simulates images that are taken now, with the given errors. The opponent is detected wherever it is in
    * view.
    *
    * @param oursX positions of the vehicles with the camera, from `oursAt` on, m
    * @param into receives [[CameraTrackerLanes.Detection]] rows; the first row is whether the opponent is
    *   detected, 1 or 0
    */
  protected final def detect(
      oursX: Array[Float],
      oursY: Array[Float],
      oursAt: Int,
      theirsX: Array[Float],
      theirsY: Array[Float],
      theirsAt: Int,
      into: Array[Float]
  ): Unit =
    detected.input(1, oursX, oursAt)
    detected.input(2, oursY, oursAt)
    detected.input(4, theirsX, theirsAt)
    detected.input(5, theirsY, theirsAt)
    detected.outputs(Detection, into, 0)
    detected()

  /** Computes the estimate after an image of each world that was taken at [[takenS]]. */
  protected final def join(belief: Array[Float], images: Array[Float], into: Array[Float]): Unit =
    joined.inputs(0, Belief, belief, 0)
    joined.inputs(Belief, Detection, images, 0)
    joined.outputs(Belief, into, 0)
    joined()

  /** Fills [[northM]] and the following arrays, and [[newAxis]], at [[nowS]].
    *
    * @param x positions of the vehicles with the camera, from `xAt` on, m
    */
  protected final def decideUpon(x: Array[Float], xAt: Int, y: Array[Float], yAt: Int): Unit =
    decided.inputs(0, Belief, newest, 0)
    decided.input(Belief + 3, x, xAt)
    decided.input(Belief + 4, y, yAt)
    decided()

  private def everywhere(value: Double) = Array.fill(WORLDS)(value.toFloat)

private[lanes] object CameraTrackerLanes:
  private val WORLDS = LanePolicy.WORLDS

  /** Number of components of a [[SensorFormulas.Believed]] and of a [[SensorFormulas.Detected]]. */
  val Belief    = 35
  val Detection = 13

  /** Smallest standard deviation of a measurement; with a smaller one, rounding of floats destroys a
    * covariance.
    */
  private val LeastSd = 2e-4

  final class Forms(
      val detected: FixedFormula,
      val joined: FixedFormula,
      val decidedUpon: FixedFormula
  )

  /** Compiles the formulas of a sensor. Left says why SIMD does not support it. */
  def of(model: SensorModel): Either[String, Forms] =
    val formulas                        = SensorFormulas(model)
    def form(name: String, inputs: Int) = FixedFormula.of(formulas, name, alike = 0).map: formula =>
      require(formula.inputs.size == inputs, s"$name of ${formula.inputs.mkString(", ")}")
      formula
    if model.bearingSdRad < LeastSd || model.rangeSd < LeastSd then
      Left(s"SIMD supports sensors with deviations of at least $LeastSd rad, and $LeastSd of the range")
    else
      (for
        detected    <- form("detected", 9)
        joined      <- form("joined", Belief + Detection + 1)
        decidedUpon <- form("decidedUpon", Belief + 8)
      yield new Forms(detected, joined, decidedUpon)).left
        .map((why: Untraceable) => s"the sensor is no formula: ${why.getMessage}")
