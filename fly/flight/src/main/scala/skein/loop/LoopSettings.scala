package skein.loop

import skein.flow.Sense
import skein.policy.{Action, ActionGuidance}
import skein.port.Moves
import skein.units.*
import skein.vehicle.{Guidance, QuadrotorModel, VehicleModel}

/** How a loop is run.
  *
  * @param period time between decisions for one vehicle
  * @param window maximum number of unanswered requests to one vehicle
  * @param moveDuration duration of every move command; a vehicle without further commands then holds its
  *   position
  * @param minCommandInterval the rate cap for one vehicle, for all loops
  * @param paceInterval minimum time of `stream` between two decisions (or commands) for one vehicle; the
  *   ticks keep the period
  * @param movesInFlight maximum number of unanswered moves of one vehicle: see [[skein.flow.Steer]]
  * @param patience longest time for which `stream` waits for the readings of the other vehicles after the
  *   first
  * @param spread time over which the ticks of the vehicles are spread
  * @param early how `stream` treats a reading that arrives before an older one of its vehicle
  * @param decideThenPace `stream` decides at every view and paces the commands, instead of pacing first and
  *   deciding on the newest view
  * @param model the model by which `predictive` and `plan` predict a vehicle from its readings
  * @param guidance how vehicles perform an action, for predictions
  * @param planning settings of `plan`
  * @param seed seed of the searches of `plan`
  * @param deadline deadline of every decision; without one a policy decides on the loop's own thread, which
  *   waits for it. `paused` has none: its time stands still
  * @param planInPacket whether `predictive` sends with each action those that it foresees, to a buffer on the
  *   vehicle's side of the link ([[skein.port.PlanBuffer]]). Such commands are answered when they arrive, so
  *   `movesInFlight` does not limit them, [[skein.port.Moves.MostInFlight]] does
  * @param knows what the controller of a vehicle knows of the other vehicles; `plan` knows everything
  * @param strangers how `predictive` predicts vehicles whose commands it does not know
  */
final case class LoopSettings(
    period: Span = Span.ofMillis(100),
    window: Int = 4,
    moveDuration: Span = Span.ofSeconds(10),
    minCommandInterval: Span = Moves.LeastInterval,
    paceInterval: Span = Span.ofMillis(50),
    movesInFlight: Int = Moves.InFlight,
    patience: Span = Span.ofMillis(100),
    spread: Span = Span.Zero,
    early: Sense.Early = Sense.Early.Overtakes,
    decideThenPace: Boolean = false,
    model: Int => VehicleModel[?] = _ => QuadrotorModel.AirSim,
    guidance: Action => Guidance = ActionGuidance.of,
    planning: PlanSettings = PlanSettings(),
    seed: Long = 1,
    deadline: Option[Deadline] = None,
    planInPacket: Boolean = false,
    knows: Knowledge = Knowledge.All,
    strangers: Strangers = Strangers.Turn
):
  require(period > Span.Zero, "the period must be positive")
  require(window > 0, "the window must be at least 1")
  for wrong <- Moves.mistake(movesInFlight) do
    throw IllegalArgumentException(s"moves in flight: $wrong")

  /** Settings of the published code: it reads the vehicles in turn, spread over the period, waits for every
    * answer in order, decides at each, and paces the commands.
    */
  def asPublished: LoopSettings =
    copy(
      paceInterval = period,
      patience = Span.Zero,
      spread = period,
      early = Sense.Early.Waits,
      decideThenPace = true
    )

object LoopSettings:

  /** Settings for a period: at least half of it between two decisions, and all of it as patience. */
  def every(period: Span): LoopSettings =
    LoopSettings(period = period, paceInterval = period / 2, patience = period)
