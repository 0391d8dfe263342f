package skein.airsim

import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.policy.{Action, Yaw}
import skein.port.{CommandPlan, Sensor, SteppedTime, VehicleError, VehiclePort}
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** A multirotor of AirSim as a loop's vehicle port.
  *
  * [[MoveQueue]] recovers from missed answers: control resumes 0.6 s and one round trip after a lost cancel,
  * one further round trip later after a lost answer, and another timeout later if the probe or the cancel is
  * lost too.
  *
  * @param onLost called with one line for each missed answer: what happened to it
  */
final class AirSimVehicle(multirotor: Multirotor, onLost: String => Unit)(using system: ActorSystem)
    extends VehiclePort:
  import VehicleErrors.errorOf
  import system.dispatcher

  private val moves = MoveQueue(multirotor, onLost)

  private val plans             = AtomicLong()
  @volatile private var follows = false

  /** Calls sent in addition to readings and moves. */
  def callsBeside: Int = moves.callsBeside

  def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
    multirotor.status().map(VehicleErrors.reading)

  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] = action match
    case Action.VelocityAt(north, east, down, yaw) =>
      val velocity = Vector3(north, east, 0)
      sent(withdrawn => multirotor.moveByVelocityZ(velocity, down, lasts, yaw, Some(withdrawn)))
    case Action.Velocity(velocityNed, yaw) =>
      sent(withdrawn => multirotor.moveByVelocity(velocityNed, lasts, yaw, Some(withdrawn)))
    case along: Action.Along                      => act(along.byVelocity, lasts)
    case Action.Position(positionNed, speed, yaw) =>
      sent(_ => multirotor.moveToPosition(positionNed, speed, timeout = lasts, yaw = yaw))
    case Action.Turn(Yaw.Towards(heading))         => sent(_ => multirotor.rotateToYaw(heading, lasts))
    case Action.Turn(Yaw.Turning(rate))            => sent(_ => multirotor.rotateByYawRate(rate, lasts))
    case Action.Turn(_)                            => hover()
    case Action.Attitude(roll, pitch, yaw, thrust) =>
      sent(_ => multirotor.moveByRollPitchYawThrottle(roll, pitch, yaw, thrust, lasts))
    case Action.Hover => hover()
    case Action.Land  => sent(_ => multirotor.land(lasts))

  override def follow(plan: CommandPlan): Future[Either[VehicleError, Boolean]] =
    if plan.actions.nonEmpty then follows = true
    multirotor.followPlan(plans.getAndIncrement(), plan).fold(
      Future.successful(Left(VehicleError.Unsupported("expected a plan of velocities, got other actions")))
    )(_.map(_.left.map(errorOf)))

  def hover(): Future[Either[VehicleError, Boolean]] =
    if follows then multirotor.endPlans(plans.getAndIncrement()).map(_.left.map(errorOf))
    else sent(_ => multirotor.hover())

  override val sensors: Map[String, Sensor] = AirSimSensors.of(multirotor)

  private def sent(
      call: Future[Unit] => Future[Either[RpcError, Boolean]]
  ): Future[Either[VehicleError, Boolean]] = moves.send(call).map(_.left.map(errorOf))

/** Pauses and steps a simulator by AirSim's own functions. */
final class AirSimTime(client: AirSimClient) extends SteppedTime:
  import VehicleErrors.errorOf
  private given ExecutionContext = ExecutionContext.parasitic

  def pause(): Future[Either[VehicleError, Unit]]                 = client.pause().map(_.left.map(errorOf))
  def resume(): Future[Either[VehicleError, Unit]]                = client.resume().map(_.left.map(errorOf))
  def continueFor(span: Span): Future[Either[VehicleError, Unit]] =
    client.continueFor(span).map(_.left.map(errorOf))
