package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.airsim.*
import skein.rpc.RpcError
import skein.signal.Kinematics
import skein.units.*

/** Brings one vehicle to a place by velocity commands, turns it to the north on the way, and lets it hover there.
  *
  * Not by position commands: AirSim's hold of a position works only while the vehicle looks north, and at more than 90°
  * of yaw it drives the vehicle away. Each command replaces the one before; at most two are under way.
  */
private[flight] final class Approach(vehicle: Multirotor, clock: Clock)(using system: ActorSystem):
  import Approach.*
  import system.dispatcher

  private val moves = MoveQueue(vehicle, _ => ())

  /** Until the vehicle hovers within `limits` of the goal.
    *
    * @param goalNed
    *   in the frame of `vehicle`
    * @return
    *   how it was seen last; `Left` where a call failed, or the vehicle was not there in twice the time that it needs
    */
  def to(goalNed: Vector3, limits: Limits): Future[Either[AirSimError, Kinematics]] =
    look: start =>
      val way   = (goalNed - start.positionNed).norm
      val until = clock.now() + Span.ofSeconds(2 * way / Cruise.value) + Patience
      steer(goalNed, limits, until, None)

  private def steer(
      goalNed: Vector3,
      limits: Limits,
      until: Instant,
      before: Option[Move]
  ): Future[Either[AirSimError, Kinematics]] =
    look: state =>
      if limits.hold(state, goalNed) then settle(goalNed, limits, until, before)
      else if clock.now() > until then
        val off = (state.positionNed - goalNed).norm
        park(before).map(_ => Left(AirSimError.NotAtStart(vehicle.name, off, state.velocityNed.norm)))
      else
        val velocity = velocityNed(state, goalNed)
        val move     = moves.send(withdrawn =>
          vehicle.moveByVelocity(velocity, Lasts, Yaw.Towards(Radians(0)), Some(withdrawn))
        )
        for
          ended <- replaced(before)
          next  <- ended match
            case Some(error) => Future.successful(Left(AirSimError.Call(error)))
            case None        =>
              after(Every.toDuration)(steer(goalNed, limits, until, Some(move)))
        yield next

  /** Lets it hover, and looks whether it stays. */
  private def settle(
      goalNed: Vector3,
      limits: Limits,
      until: Instant,
      before: Option[Move]
  ): Future[Either[AirSimError, Kinematics]] =
    def watch(looks: Int, good: Int): Future[Either[AirSimError, Kinematics]] = look: state =>
      val stays = if limits.hold(state, goalNed) then good + 1 else 0
      if stays == GoodLooks then Future.successful(Right(state))
      else if looks == 1 then steer(goalNed, limits, until, None)
      else after(Every.toDuration)(watch(looks - 1, stays))
    park(before).flatMap:
      case Some(error) => Future.successful(Left(AirSimError.Call(error)))
      case None        => watch(Looks, 0)

  private def park(before: Option[Move]): Future[Option[RpcError]] =
    val hover = moves.send(_ => vehicle.hover())
    for
      moved <- replaced(before)
      hangs <- hover
    yield moved.orElse(hangs.left.toOption)

  private def replaced(move: Option[Move]): Future[Option[RpcError]] =
    move.fold(Future.successful(None))(_.map(_.left.toOption))

  private def look(
      next: Kinematics => Future[Either[AirSimError, Kinematics]]
  ): Future[Either[AirSimError, Kinematics]] =
    vehicle
      .kinematics()
      .flatMap:
        case Left(error)  => Future.successful(Left(AirSimError.Call(error)))
        case Right(state) => next(state.value)

private[flight] object Approach:
  private type Move = Future[Either[RpcError, Boolean]]

  /** How near to its goal a vehicle has to be, how slow, and how well it looks north. */
  final case class Limits(off: Metres, speed: MetresPerSecond, yaw: Radians):
    def hold(state: Kinematics, goalNed: Vector3): Boolean =
      (state.positionNed - goalNed).norm <= off.value &&
        state.velocityNed.norm <= speed.value && math.abs(yawRad(state.orientation)) <= yaw.value

  /** On the way. */
  val Passing: Limits = Limits(Metres(1), MetresPerSecond(0.5), Radians(math.toRadians(10)))

  /** At a start. A flight may begin 0.3 m off and at 0.1 m/s; a hover moves a little more before it settles. */
  val AtRest: Limits = Limits(Metres(0.15), MetresPerSecond(0.05), Radians(math.toRadians(3)))

  private val Cruise = MetresPerSecond(5)

  /** Of one command; should the next one never come, the vehicle hovers after it. */
  private val Lasts = Span.ofSeconds(1)

  private val Every = Span.ofMillis(100)

  /** Beyond twice the time of the way. */
  private val Patience = Span.ofSeconds(40)

  /** How often a vehicle that hovers is looked at, and how often in a row it has to be where it should. */
  private val Looks     = 40
  private val GoodLooks = 10

  // A vehicle that follows its command with a lag of 0.9 s, as AirSim's does by `moveByVelocity`, comes to its goal by these
  // without passing it: 1.5² = 4 · 0.6 · 0.9, nearly.
  private val PerMetre = 0.6
  private val Damping  = 0.5

  /** The velocity to command, NED. */
  def velocityNed(state: Kinematics, goalNed: Vector3): Vector3 =
    val wanted = (goalNed - state.positionNed) * PerMetre
    val most   = Cruise.value * (1 + Damping)
    val within = if wanted.norm > most then wanted * (most / wanted.norm) else wanted
    within - state.velocityNed * Damping

  private def yawRad(q: Quaternion): Double =
    StrictMath.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
