package skein.loop

import skein.forecast.Evidence
import skein.record.Reading
import skein.signal.Stamped

/** What enters the picture. */
enum Percept:
  /** Readings by vehicle, and the vehicles to decide upon them. */
  case Seen(readings: Map[Int, Reading], deciders: Set[Int])

  /** A reading that nobody decides upon at once. */
  case Read(vehicle: Int, reading: Reading)

  /** What a sensor said. */
  case Measured(reading: SensorReading)

  /** The vehicles to decide upon what is known. */
  case Due(deciders: Set[Int])

  /** A command that was sent. */
  case Moved(move: Move)

  /** What a forecast is told of besides. */
  case Heard(evidence: Evidence)

/** What a sensor of a vehicle said.
  *
  * @param sequence
  *   counts the answers asked of this sensor, in the order in which they were asked for
  * @param columns
  *   names of the values, with units
  */
final case class SensorReading(
    vehicle: Int,
    sensor: String,
    sequence: Long,
    columns: Vector[String],
    values: Stamped[Vector[Double]]
)

/** A picture and the vehicles to decide upon it. */
final case class Sight(picture: Picture, deciders: Set[Int])
