package skein.forward

import skein.port.Moves
import skein.units.Span
import skein.vehicle.{QuadrotorModel, VehicleModel}

/** The timing of a control loop as data. It determines when an observation is taken, how old it is at the
  * decision, when the command takes effect, and which messages replace earlier ones. [[Rollout]] derives its
  * events from it; the kernels derive equal events with SIMD.
  *
  * '''What all loops share''' (except `Paused`, in which nothing takes time):
  *   - A request, its answer, a command and the command's answer take a one-way delay each ([[Delays]]). A
  *     reading is the vehicle's state at the arrival of the request. Requests go over a pool of connections
  *     and may overtake one another, and so may their answers. Commands to one vehicle keep their order, and
  *     so do their answers.
  *   - A request not answered in time has failed ([[Asking]]).
  *   - The first command takes effect when it arrives; a command that replaces another does so after the
  *     vehicle's handover time ([[VelocityResponse.handoverS]]). A command is answered at the arrival of its
  *     successor; the newest command is unanswered.
  *   - [[Steering]] decides when a vehicle may be commanded. A view or decision that waits is replaced by a
  *     newer one.
  *   - A view contains a reading of each vehicle, and the headings sent to both until then. A policy knows
  *     the opponent's heading from the view alone, and not from later commands.
  *
  * `skein.loop.LoopTimings` derives the timing of the live loops from their settings;
  * `RolloutParitySimulation` compares each case with its live loop in virtual time.
  */
enum LoopTiming:
  def periodS: Double

  def asking: Asking     = Asking()
  def steering: Steering = Steering()

  /** The world stands still while all vehicles are read, decided for and commanded; then it runs one period.
    */
  case Paused(periodS: Double = 0.1)

  /** Reads the vehicles in sequence; at the last answer decides for all and commands all. The next round
    * begins one period after that answer, or after a failed request. A decision waits until it may be sent.
    */
  case Sequential(
      periodS: Double = 0.1,
      override val asking: Asking = Asking(),
      override val steering: Steering = Steering()
  )

  /** Every period begins one task per vehicle. A task reads all vehicles in sequence; at the last answer it
    * decides for its own vehicle and commands it. Up to `window` tasks per vehicle may overlap; a further
    * task waits, and the periods that begin meanwhile are missed. A decision waits until it may be sent. If
    * two tasks end in one nanosecond, which requires a link without jitter, the one that started first
    * decides first; the streams of a live flight may order them differently.
    */
  case Futures(
      periodS: Double = 0.1,
      override val asking: Asking = Asking(),
      override val steering: Steering = Steering()
  )

  /** Reads every vehicle once a period, while fewer than `window` of its requests are unanswered. The newest
    * readings are joined to a view when each vehicle has a new reading since the last view, or `patienceS`
    * after the first new reading. A reading is dropped if an answer to a later request overtook it, or if it
    * was sampled before the present reading. A vehicle decides on the newest view as soon as `periodS −
    * toleranceS` has passed since its last decision and it may be commanded. A view that is replaced by a
    * newer one before that is skipped.
    *
    * @param toleranceS time by which two decisions may be closer than a period; live loops take half a period
    * @param decideThenPace decides on every view; interval and steering then delay decisions instead of views
    */
  case Stream(
      periodS: Double = 0.1,
      toleranceS: Double = 0.05,
      patienceS: Double = 0.1,
      decideThenPace: Boolean = false,
      override val asking: Asking = Asking(),
      override val steering: Steering = Steering()
  )

  /** Reads like `Stream`. Readings, commands and their answers are added to a [[skein.forecast.Forecast]] as
    * they arrive. Half-way between two requests a decision becomes due for every vehicle, based on what is
    * known at that time. A vehicle decides as soon as it may be commanded, unless its next decision becomes
    * due before that. The decision uses the states of all vehicles, predicted for the time at which a command
    * that is sent now takes effect.
    *
    * @param predictor predicts each vehicle from its readings
    */
  case Predictive(
      periodS: Double = 0.1,
      predictor: VehicleModel[?] = QuadrotorModel.AirSim,
      override val asking: Asking = Asking(),
      override val steering: Steering = Steering()
  )

object LoopTiming:
  /** The `stream` loop as in live flights: two decisions are at least half a period apart, and the patience
    * is one period.
    */
  def stream(periodS: Double): LoopTiming.Stream =
    LoopTiming.Stream(periodS, toleranceS = periodS / 2, patienceS = periodS)

/** How a loop reads vehicles.
  *
  * @param window maximum number of unanswered requests to one vehicle; a request that becomes due meanwhile
  *   waits, a second one is missed
  * @param timeoutS time after which a request has failed
  * @param spreadS time over which the requests to n vehicles are spread: vehicle i is read spreadS · i/n
  *   later than vehicle 0
  * @param inOrder whether an answer waits until all older requests were answered or failed
  */
final case class Asking(
    window: Int = 4,
    timeoutS: Double = Asking.Timeout.toSeconds,
    spreadS: Double = 0.0,
    inOrder: Boolean = false
):
  require(window > 0 && window <= 16, s"the window must be from 1 to 16, got $window")

object Asking:
  /** Time after which a request to a simulator has failed, as in the paper. */
  val Timeout: Span = Span.ofMillis(500)

/** When a vehicle may be commanded, as `skein.flow.Steer` decides: when fewer than `mostOutstanding` commands
  * are unanswered, `minIntervalS` has passed since the last command, and `handoverS` has passed since an
  * answer that left another command unanswered. The permission lasts until the next command.
  */
final case class Steering(
    minIntervalS: Double = Moves.LeastInterval.toSeconds,
    mostOutstanding: Int = Moves.InFlight,
    handoverS: Double = Moves.HandoverAllowed.toSeconds
):
  for wrong <- Moves.mistake(mostOutstanding) do
    throw IllegalArgumentException(s"moves that may be outstanding: $wrong")
