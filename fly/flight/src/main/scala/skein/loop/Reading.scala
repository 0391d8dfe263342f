package skein.loop

import skein.signal.{Kinematics, Stamped}

/** The position and motion that a vehicle reported.
  *
  * @param sequence counts the readings of this vehicle in the order of the requests
  */
final case class Reading(vehicle: Int, sequence: Long, state: Stamped[Kinematics])

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
