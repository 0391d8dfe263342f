package skein.flight

import scala.concurrent.{ExecutionContext, Future}
import skein.port.{SteppedTime, VehiclePort}
import skein.signal.ClockAlignment

/** The vehicles of a flight, connected and at their starts.
  *
  * @param where the vehicles are, for a person
  * @param ping whether the simulator answers now
  * @param isOther see [[SimulatorWatchdog]]
  * @param cameras the cameras with recognisers
  * @param films the vehicles' other cameras
  * @param clocks the vehicles' clock against the controller's, if it is known already
  * @param apart if each vehicle has its own controller: for a vehicle `self`, all vehicles over that
  *   controller's connections. `vehicles` are then over the connections of their own controllers
  */
private[flight] final case class ConnectedFleet(
    vehicles: Vector[VehiclePort],
    time: Option[SteppedTime],
    where: String,
    ping: () => Future[Boolean],
    isOther: () => Future[Either[String, Option[String]]],
    cameras: Vector[CameraSensor] = Vector.empty,
    films: Vector[FilmedCamera] = Vector.empty,
    clocks: Option[ClockAlignment] = None,
    apart: Vector[(self: Int, vehicles: Vector[VehiclePort])] = Vector.empty
)

/** A flight cannot be started; the reason is a line for the user. */
private[flight] final case class CannotFly(reason: String) extends RuntimeException(reason)

private[flight] object CannotFly:
  /** The value of an answer; an error fails with the line that `why` makes of it. */
  def unless[E, A](answer: Future[Either[E, A]])(why: E => String)(using ExecutionContext): Future[A] =
    answer.map(_.fold(error => throw CannotFly(why(error)), identity))
