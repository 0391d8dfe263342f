package skein.loop

import skein.record.{ReadingRow, Recording, RecordingHeader}
import skein.signal.{Kinematics, Stamped}
import skein.units.Instant

/** The position and motion that a vehicle reported.
  *
  * @param sequence counts the readings of this vehicle in the order of the requests: see [[Reading.number]]
  */
final case class Reading(vehicle: Int, sequence: Long, state: Stamped[Kinematics]):
  /** This reading as another vehicle's controller received it in a message, numbered as that controller's
    * own.
    */
  private[skein] def relayed(from: Int, to: Int, receivedAt: Instant): Reading =
    copy(sequence = sequence - from + to, state = state.copy(receivedAt = receivedAt))

object Reading:
  /** The number of a controller's n-th reading of a vehicle. Of C controllers with a vehicle each, controller
    * c uses the numbers c, c + C, c + 2C, …: no two readings have one number, and it identifies the
    * controller.
    */
  private[loop] def number(nth: Long, own: Vector[Int], vehicles: Int): Long =
    if own.sizeIs == vehicles then nth else nth * vehicles + own.head

  /** Number of controllers that read each vehicle in a recorded flight. The remainder of a reading's number
    * identifies its controller.
    */
  private[skein] def controllers(heading: RecordingHeader): Int =
    if heading.parameter("decentralised").contains("true") then heading.vehicles.size else 1

  /** The readings that controllers requested themselves, without those received in messages of other
    * controllers.
    */
  private[skein] def asked(recording: Recording): Vector[ReadingRow] =
    if recording.heading.parameter("between").isEmpty then recording.readings
    else
      val indexOf = recording.heading.vehicles.map(_.name).zipWithIndex.toMap
      recording.readings.filter(read => read.sequence % indexOf.size == indexOf(read.vehicle))

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
