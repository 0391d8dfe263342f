package skein.loop

import java.util.concurrent.atomic.AtomicLong
import scala.concurrent.{ExecutionContext, Future}
import skein.port.{Sensor, VehicleError}

/** A vehicle's sensor, whose readings and errors are recorded. */
private final class TeamSensor(val vehicle: Int, val name: String, sensor: Sensor, log: TeamLog)(using
    ExecutionContext
):
  private val asked   = AtomicLong()
  private val columns = sensor.columns

  /** Reads it; records the answer or the error. An answer is an error if it does not have one finite value
    * for each column.
    */
  def read(): Future[Either[VehicleError, SensorReading]] =
    val sequence = asked.getAndIncrement()
    sensor
      .read()
      .map(_.flatMap: answer =>
        val values = answer.value.toVector
        Either.cond(
          values.size == columns.size && values.forall(_.isFinite),
          SensorReading(vehicle, name, sequence, columns, answer.map(_ => values)),
          VehicleError.Malformed(s"expected ${columns.mkString(", ")}, got ${values.mkString(", ")}")
        ))
      .map:
        case Right(reading) =>
          log.sensed(reading)
          Right(reading)
        case Left(error) =>
          log.failed(vehicle, s"$name $sequence", error)
          Left(error)
