package skein.flight

import org.apache.pekko.Done
import scala.concurrent.Future
import skein.policy.{Action, ActionGuidance}
import skein.port.VehiclePort
import skein.signal.ClockAlignment
import skein.vehicle.Guidance

/** Vehicles that are reached neither by AirSim's protocol nor by MAVLink: another part of the program
  * connects to them.
  */
trait VehicleSource:
  /** A word for messages that states where the vehicles are. */
  def where: String

  /** How its vehicles perform an action, for predictions. */
  def guidance: Action => Guidance = ActionGuidance.of

  /** Connects to the vehicles of a flight.
    *
    * @param names the vehicles' names, in the flight's order
    * @return Left says what is missing
    */
  def open(names: Vector[String]): Future[Either[String, VehicleSource.Opened]]

object VehicleSource:
  /** Connected vehicles.
    *
    * @param clocks the vehicles' clock against the controller's
    */
  final case class Opened(
      vehicles: Vector[VehiclePort],
      clocks: () => Option[ClockAlignment],
      close: () => Future[Done]
  )
