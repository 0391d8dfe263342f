package skein.offboard

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** A MAVLink vehicle as a loop's vehicle port: controlled in PX4's offboard mode, or in Guided of ArduPilot's
  * copter. Not for real aircraft.
  *
  * A reading is the next sample that the vehicle sends. An action ends as replaced when the vehicle has
  * received its successor.
  */
final class MavlinkVehicle(link: MavlinkLink, number: Int)(using system: ActorSystem) extends VehiclePort:
  import system.dispatcher

  def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
    link
      .ask(number)((control, token, now) => control.read(token, now))
      .map(_.map:
        case told: Stamped[Kinematics @unchecked] => told
        case _: Boolean => throw IllegalStateException("a reading was answered as an action"))

  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
    done((control, token, now) => control.act(token, action, lasts, now))

  def hover(): Future[Either[VehicleError, Boolean]] =
    done((control, token, now) => control.hover(token, now))

  def arm(): Future[Either[VehicleError, Boolean]] = done((control, token, now) => control.arm(token, now))

  /** Stops the motors immediately, in any state of the vehicle; the link is ready for it. */
  def kill(): Future[Either[VehicleError, Boolean]] = done((control, token, now) => control.kill(token, now))

  /** Takes off to the autopilot's own height, or 2.5 m; answers when takeoff begins. */
  def takeoff(): Future[Either[VehicleError, Boolean]] =
    done((control, token, now) => control.takeoff(token, now))

  def isArmed: Boolean    = link.control(number).isArmed
  def isOnGround: Boolean = link.control(number).isOnGround

  /** The reason why the vehicle follows no setpoints; None if it follows them. */
  def taken: Option[String] = link.control(number).taken

  private def done(what: Control.Request): Future[Either[VehicleError, Boolean]] =
    link
      .ask(number)(what)
      .map(_.map:
        case answer: Boolean => answer
        case _               => throw IllegalStateException("an action was answered as a reading"))
