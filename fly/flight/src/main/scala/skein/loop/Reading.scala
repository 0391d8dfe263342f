package skein.loop

import skein.record.RecordingHeader
import skein.signal.{Kinematics, Stamped}

/** The position and motion that a vehicle reported.
  *
  * @param sequence counts the readings of this vehicle in the order of the requests: see [[Reading.number]]
  */
final case class Reading(vehicle: Int, sequence: Long, state: Stamped[Kinematics])

object Reading:
  /** The number of a controller's n-th reading of a vehicle. Of C controllers with a vehicle each, number c
    * has the numbers c, c + C, c + 2C, …: no two readings have one number, and it says whose a reading is.
    */
  private[loop] def number(nth: Long, own: Vector[Int], vehicles: Int): Long =
    if own.sizeIs == vehicles then nth else nth * vehicles + own.head

  /** How many controllers read each vehicle in a recorded flight. The one of `number` is its remainder. */
  private[skein] def controllers(heading: RecordingHeader): Int =
    if heading.parameter("decentralised").contains("true") then heading.vehicles.size else 1

/** The values that a sensor of a vehicle reported.
  *
  * @param sequence counts the readings of this sensor in the order of the requests
  * @param columns names of the values, with units
  */
final case class SensorReading(
    vehicle: Int,
    sensor: String,
    sequence: Long,
    columns: Vector[String],
    values: Stamped[Vector[Double]]
)
