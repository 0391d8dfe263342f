package skein.port

import scala.concurrent.Future
import skein.policy.Action
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** One vehicle as a loop sees it: all that a simulator, or a real vehicle, has to offer to be flown. Every call ends by
  * itself, within a time of its own, and fails by a [[VehicleError]], never by an exception.
  */
trait VehiclePort:

  /** Where the vehicle is and how it moves, world NED, by its own estimate.
    *
    * @return
    *   with the moment at which that was so, on the vehicle's clock, which is one for all vehicles of a flight (vehicles
    *   with clocks of their own are brought to one by their adapter, see [[skein.signal.ClockAlignment]]), and when it was asked for and answered, on the
    *   controller's
    */
  def read(): Future[Either[VehicleError, Stamped[Kinematics]]]

  /** Does this until `lasts` is over or a newer action takes its place. The answer comes then: true when it was done to
    * its end, false when it was replaced. Actions act in the order in which they were asked for.
    */
  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]]

  /** Ends every action; the vehicle holds its position. Answers when it does. */
  def hover(): Future[Either[VehicleError, Boolean]]

  /** What may be measured, by name. */
  def sensors: Map[String, Sensor] = Map.empty

/** Something that a vehicle measures. */
trait Sensor:

  /** Names and units of the numbers of a reading, such as `altitudeM`. */
  def columns: Vector[String]

  /** The newest reading: as many numbers as there are columns. */
  def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]]

/** A simulator whose time a loop lets pass in steps. */
trait SteppedTime:
  /** Stands the simulator still. */
  def pause(): Future[Either[VehicleError, Unit]]

  /** Lets it run on by itself. */
  def resume(): Future[Either[VehicleError, Unit]]

  /** Runs it for exactly `span`; answers when it stands still again. */
  def continueFor(span: Span): Future[Either[VehicleError, Unit]]
