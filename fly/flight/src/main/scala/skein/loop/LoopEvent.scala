package skein.loop

import skein.forecast.ForecastEvent
import skein.port.CommandPlan

/** An event that updates a loop's view of the team. */
enum LoopEvent:
  /** Readings of different vehicles, and the vehicles that must decide on them. */
  case Seen(readings: Vector[Reading], deciders: Set[Int])

  /** A reading without an immediate decision. */
  case Read(reading: Reading)

  case Measured(reading: SensorReading)

  /** The vehicles that must decide on the present view. */
  case Due(deciders: Set[Int])

  /** A command was sent.
    *
    * @param plan the plan sent with it
    */
  case Moved(move: SentCommand, plan: Option[CommandPlan] = None)

  /** A further event that updates the forecast. */
  case Heard(event: ForecastEvent)

/** A view with the vehicles that must decide on it. */
final case class DecisionRequest(view: TeamView, deciders: Set[Int])
