package skein.forward

import skein.port.Moves
import skein.units.Span
import skein.vehicle.{QuadrotorModel, VehicleModel}

/** The timing of a control loop as data: when an observation is taken, how old it is at the decision, when
  * the command takes effect, what replaces what. [[Rollout]] derives its events from it; the kernels derive
  * equal events by SIMD.
  *
  * '''What all loops share''' (but `Paused`, where nothing takes time):
  *   - A request, its answer, a command and the command's answer take a one-way delay each ([[Delays]]). A
  *     reading shows the vehicle as it is when the request reaches it. Requests go over a pool of connections
  *     and may overtake one another, so may their answers; commands to one vehicle keep their order, so do
  *     their answers.
  *   - A request not answered in time has failed ([[Asking]]).
  *   - A command takes effect when it arrives; one that replaces another, the vehicle's own handover later
  *     ([[VelocityResponse.handoverS]]). The one replaced is answered at the arrival of its successor, the
  *     newest not at all.
  *   - [[Steering]] decides when a vehicle may be commanded. What waits meanwhile is replaced by anything
  *     newer.
  *   - A view holds a reading of each vehicle and the headings sent to both so far. A policy knows the
  *     opponent's heading from the view: what was sent to the opponent later it does not know.
  *
  * `skein.loop.LoopTimings` gives the timing of the live loops by their settings; `RolloutParitySimulation`
  * holds each case to its loop in virtual time.
  */
enum LoopTiming:
  def periodS: Double

  /** The world stands still while all vehicles are read, decided for and commanded; then it runs one period.
    */
  case Paused(periodS: Double = 0.1)

  /** Reads the vehicles in sequence, decides for all at the last answer and commands all; the next round
    * begins one period after that answer, or after a failed request. A decision waits until it may be sent.
    */
  case Sequential(
      periodS: Double = 0.1,
      asking: Asking = Asking(),
      steering: Steering = Steering()
  )

  /** Every period begins one task per vehicle: it reads all vehicles in sequence, decides for its own at the
    * last answer and commands it. Tasks may overlap, `window` for each vehicle; a further one waits, and
    * later periods are missed. A decision waits until it may be sent. If tasks of two vehicles end in one
    * nanosecond, which needs a link without jitter, the one started first decides first; a flight's streams
    * may choose otherwise.
    */
  case Futures(
      periodS: Double = 0.1,
      asking: Asking = Asking(),
      steering: Steering = Steering()
  )

  /** Reads every vehicle once a period, while no more than `window` of its requests are unanswered; the
    * newest readings are joined to a view when each vehicle's was renewed since the last view, or `patienceS`
    * after the first of them was. A reading that an answer to a later request overtook, or that was sampled
    * before the one held, is dropped. Each vehicle decides on the newest view once an interval of `periodS −
    * toleranceS` is over since it last did and it may be commanded; a view that a newer one replaces before
    * is skipped.
    *
    * @param toleranceS how much less than a period may pass between two decisions; live loops take half a
    *   period
    * @param decideThenPace decides at every view; interval and steering then hold decisions back instead of
    *   views
    */
  case Stream(
      periodS: Double = 0.1,
      toleranceS: Double = 0.05,
      patienceS: Double = 0.1,
      decideThenPace: Boolean = false,
      asking: Asking = Asking(),
      steering: Steering = Steering()
  )

  /** Reads like `Stream`; readings, commands and their answers are added to a [[skein.forecast.Forecast]] as
    * they arrive. Half-way between two requests every vehicle is due to decide on what is known then; it does
    * so once it may be commanded, unless it is due anew before. It decides on the states of all vehicles
    * predicted for the time at which a command sent at that moment takes effect.
    *
    * @param predictor predicts each vehicle from its readings
    */
  case Predictive(
      periodS: Double = 0.1,
      predictor: VehicleModel[?] = QuadrotorModel.AirSim,
      asking: Asking = Asking(),
      steering: Steering = Steering()
  )

object LoopTiming:
  /** The `stream` loop of a period as in live flights: at least half of it between two decisions, and all of
    * it as patience.
    */
  def stream(periodS: Double): LoopTiming.Stream =
    LoopTiming.Stream(periodS, toleranceS = periodS / 2, patienceS = periodS)

  private[skein] def askingOf(timing: LoopTiming): Asking = timing match
    case _: LoopTiming.Paused              => Asking()
    case sequential: LoopTiming.Sequential => sequential.asking
    case futures: LoopTiming.Futures       => futures.asking
    case stream: LoopTiming.Stream         => stream.asking
    case predictive: LoopTiming.Predictive => predictive.asking

  private[skein] def steeringOf(timing: LoopTiming): Steering = timing match
    case _: LoopTiming.Paused              => Steering()
    case sequential: LoopTiming.Sequential => sequential.steering
    case futures: LoopTiming.Futures       => futures.steering
    case stream: LoopTiming.Stream         => stream.steering
    case predictive: LoopTiming.Predictive => predictive.steering

/** How vehicles are read.
  *
  * @param window limit of unanswered requests to one vehicle; a request due meanwhile waits, a second one is
  *   missed
  * @param timeoutS after which a request has failed
  * @param spreadS over which the requests to the vehicles are spread: of n, the i-th is sent i/n of it later
  * @param inOrder an answer waits until those to all older requests were received or failed
  */
final case class Asking(
    window: Int = 4,
    timeoutS: Double = Asking.Timeout.toSeconds,
    spreadS: Double = 0.0,
    inOrder: Boolean = false
):
  require(window > 0 && window <= 16, s"the window must be from 1 to 16, got $window")

object Asking:
  /** Time after which a request to a simulator has failed; the paper's. */
  val Timeout: Span = Span.ofMillis(500)

/** When a vehicle may be commanded, as `skein.flow.Steer` decides: while fewer than `mostOutstanding`
  * commands are unanswered, `minIntervalS` after the last one, and `handoverS` after an answer that leaves
  * one under way. The permission lasts until the next command.
  */
final case class Steering(
    minIntervalS: Double = Moves.LeastInterval.toSeconds,
    mostOutstanding: Int = Moves.InFlight,
    handoverS: Double = Moves.HandoverAllowed.toSeconds
):
  for wrong <- Moves.mistake(mostOutstanding) do
    throw IllegalArgumentException(s"moves that may be outstanding: $wrong")
