package skein.flight

import scala.concurrent.Future
import skein.port.{SteppedTime, VehiclePort}
import skein.signal.ClockAlignment

/** The vehicles of a flight, reached over a wire and at their starts.
  *
  * @param where the vehicles are, for a person
  * @param isOther see [[SimulatorWatchdog]]
  * @param cameras what recognises in their cameras' images
  * @param films of their other cameras
  * @param clocks the vehicles' clock against the controller's, where it is known already
  */
private[flight] final case class ConnectedFleet(
    vehicles: Vector[VehiclePort],
    time: Option[SteppedTime],
    where: String,
    ping: () => Future[Any],
    isOther: () => Future[Either[String, Option[String]]],
    cameras: Vector[CameraSensor] = Vector.empty,
    films: Vector[FilmedCamera] = Vector.empty,
    clocks: Option[ClockAlignment] = None
)

/** Why a flight cannot be flown, as a line for a person. */
private[flight] final case class CannotFly(reason: String) extends RuntimeException(reason)
