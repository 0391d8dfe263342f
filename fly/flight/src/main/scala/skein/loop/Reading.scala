package skein.loop

import skein.signal.{Kinematics, Stamped}

/** Where a vehicle was and how it moved, as it told.
  *
  * @param sequence counts the readings of this vehicle in the order in which they were asked for
  */
final case class Reading(vehicle: Int, sequence: Long, state: Stamped[Kinematics])

/** What a sensor of a vehicle said.
  *
  * @param sequence counts the answers asked of this sensor, in the order in which they were asked for
  * @param columns names of the values, with units
  */
final case class SensorReading(
    vehicle: Int,
    sensor: String,
    sequence: Long,
    columns: Vector[String],
    values: Stamped[Vector[Double]]
)
