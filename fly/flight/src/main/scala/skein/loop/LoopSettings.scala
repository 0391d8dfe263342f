package skein.loop

import skein.flow.Sense
import skein.port.Moves
import skein.units.*
import skein.vehicle.{QuadrotorModel, VehicleModel}

/** How a loop is run.
  *
  * @param period between decisions for one vehicle
  * @param window questions to one vehicle that may be unanswered at once
  * @param moveDuration of every move command; the vehicle holds its position when it hears nothing for so
  *   long
  * @param minCommandInterval the rate cap for one vehicle, whatever the loop does
  * @param paceInterval that `stream` keeps at least between two decisions (or commands) for one vehicle; the
  *   ticks keep the period
  * @param movesInFlight moves of one vehicle that may be unanswered: see [[skein.flow.Steer]]
  * @param patience how long `stream` waits for the readings of the other vehicles when one has come
  * @param spread over which the ticks of the vehicles are spread
  * @param early what `stream` does with a reading that comes before an older one of the same vehicle
  * @param decideThenPace `stream` decides at every view and paces the commands, instead of pacing first and
  *   deciding with the newest view
  * @param model by which `predictive` and `plan` carry the readings of a vehicle forward
  * @param planning how `plan` plans
  * @param seed of its searches
  * @param deadline of every decision; without one a policy decides on the loop's own thread and is waited
  *   for. `paused` has none: its time stands still
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
    planning: PlanSettings = PlanSettings(),
    seed: Long = 1,
    deadline: Option[Deadline] = None
):
  require(period > Span.Zero, "the period must be positive")
  require(window > 0, "the window must be at least 1")
  for wrong <- Moves.mistake(movesInFlight) do
    throw IllegalArgumentException(s"moves in flight: $wrong")

  /** As the published code does: it asks the vehicles in turn, spread over the period, waits for every answer
    * in order, decides at each, and paces the commands.
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

  /** Settings for a period: half of it between two decisions at least, and all of it as patience. */
  def every(period: Span): LoopSettings =
    LoopSettings(period = period, paceInterval = period / 2, patience = period)
