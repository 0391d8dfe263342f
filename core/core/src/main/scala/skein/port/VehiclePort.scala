package skein.port

import scala.concurrent.Future
import skein.policy.Action
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** One vehicle as a loop sees it: the interface that an adapter implements for a simulator. Every call
  * completes within its own time limit, and reports failures as a [[VehicleError]], never as an exception.
  */
trait VehiclePort:

  /** Reads position, velocity and attitude, world NED, as estimated by the vehicle.
    *
    * @return the reading with its valid time on the vehicles' clock, and with the times of request and answer
    *   on the controller's clock. All vehicles of a flight share one clock; if they do not, their adapter
    *   converts times (see [[skein.signal.ClockAlignment]])
    */
  def read(): Future[Either[VehicleError, Stamped[Kinematics]]]

  /** Performs an action until `lasts` has passed or a newer action replaces it. Completes at that time: with
    * true if the action ran to its end, false if it was replaced. Actions take effect in the order of the
    * calls.
    */
  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]]

  /** Sends a plan to the buffer on the vehicle's side of the link, which performs each action at its time:
    * see [[PlanBuffer]]. Completes with true when the buffer has received it.
    *
    * @return [[VehicleError.Unsupported]] or [[VehicleError.Refused]] if there is no such buffer
    */
  def follow(plan: CommandPlan): Future[Either[VehicleError, Boolean]] =
    val reason = s"plan ${plan.sequence}: no buffer beside this vehicle holds plans"
    Future.successful(Left(VehicleError.Unsupported(reason)))

  /** Ends all actions and plans. Completes when the vehicle holds its position. */
  def hover(): Future[Either[VehicleError, Boolean]]

  def sensors: Map[String, Sensor] = Map.empty

/** A sensor of a vehicle that policies can read. */
trait Sensor:

  /** Names of a reading's components, with units, such as `altitudeM`. */
  def columns: Vector[String]

  /** Requests the newest reading: one value per column. */
  def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]]

/** A simulator that can be stopped and run in steps, as the loop `paused` requires. */
trait SteppedTime:
  def pause(): Future[Either[VehicleError, Unit]]

  def resume(): Future[Either[VehicleError, Unit]]

  /** Runs the simulator for exactly `span`; completes when it has stopped again. */
  def continueFor(span: Span): Future[Either[VehicleError, Unit]]
