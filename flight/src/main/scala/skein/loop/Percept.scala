package skein.loop

import skein.forecast.Evidence
import skein.record.Reading

/** What enters the picture. */
enum Percept:
  /** Readings by vehicle, and the vehicles to decide upon them. */
  case Seen(readings: Map[Int, Reading], deciders: Set[Int])

  /** A reading that nobody decides upon at once. */
  case Read(vehicle: Int, reading: Reading)

  /** The vehicles to decide upon what is known. */
  case Due(deciders: Set[Int])

  /** A command that was sent. */
  case Moved(move: Move)

  /** What a forecast is told of besides. */
  case Heard(evidence: Evidence)

/** A picture and the vehicles to decide upon it. */
final case class Sight(picture: Picture, deciders: Set[Int])
