package skein.loop

import skein.forecast.ForecastEvent

/** An event that the view takes in. */
enum LoopEvent:
  /** Readings of different vehicles, and the vehicles to decide upon them. */
  case Seen(readings: Vector[Reading], deciders: Set[Int])

  /** A reading that nobody decides upon at once. */
  case Read(reading: Reading)

  /** What a sensor said. */
  case Measured(reading: SensorReading)

  /** The vehicles to decide upon what is known. */
  case Due(deciders: Set[Int])

  /** A command that was sent. */
  case Moved(move: SentCommand)

  /** A further event for the forecast. */
  case Heard(event: ForecastEvent)

/** A view and the vehicles to decide upon it. */
final case class DecisionRequest(view: TeamView, deciders: Set[Int])
