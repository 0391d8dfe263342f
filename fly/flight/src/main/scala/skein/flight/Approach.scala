package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import scala.util.Failure
import skein.policy.{Action, Yaw}
import skein.port.{VehicleError, VehiclePort}
import skein.signal.Kinematics
import skein.units.*
import skein.units.Decimals.fixed
import skein.vehicle.GoTo

/** Moves one vehicle to a position by velocity commands, turns it to the north on the way, and lets it hover
  * there.
  *
  * Position commands are unsuitable: AirSim's hold of a position works only while the vehicle looks north,
  * and at more than 90° of yaw it drives the vehicle away. Each command replaces the one before; at most two
  * are unanswered.
  *
  * @param calledOff why it must stop, evaluated at every step
  * @param truth reads where the vehicle truly is; without it, its own readings count
  */
private[flight] final class Approach(
    name: String,
    vehicle: VehiclePort,
    clock: Clock,
    calledOff: () => Option[String] = () => None,
    truth: Option[() => Future[Kinematics]] = None
)(using
    system: ActorSystem
):
  import Approach.*
  import system.dispatcher

  /** Moves the vehicle until it hovers within `limits` of the goal; fails with [[CannotFly]] if a call
    * failed, or the vehicle did not arrive within the allowed time.
    *
    * @param goalNed the goal, in the frame of `vehicle`
    */
  def to(goalNed: Vector3, limits: Limits): Future[Unit] =
    look().flatMap: start =>
      val way   = (goalNed - start.positionNed).norm
      val until = clock.now() + Span.ofSeconds(2 * way / Cruise.value) + Patience
      steer(Goal(goalNed, limits, until), None)

  private def steer(goal: Goal, before: Option[Move]): Future[Unit] =
    look().flatMap: state =>
      val isHeld = goal.isHeld(state)
      val late   = Option.when(!isHeld && clock.now() > goal.until):
        val off = (state.positionNed - goal.placeNed).norm
        s"'$name' did not come to rest at its start: ${off.fixed(1)} m off, at " +
          s"${state.velocityNed.norm.fixed(2)} m/s; is something in its way?"
      calledOff().orElse(late) match
        case Some(why)      => park(before).transform(_ => Failure(CannotFly(why)))
        case None if isHeld => settle(goal, before)
        case None           =>
          val velocity = GoTo.velocityNed(state.positionNed, state.velocityNed, goal.placeNed, Cruise)
          val move     = vehicle.act(Action.Velocity(velocity, Yaw.Towards(Radians(0))), Lasts)
          replaced(before).flatMap(_ => after(Every.toDuration)(steer(goal, Some(move))))

  /** Commands the vehicle to hover, and checks whether it stays at the goal. */
  private def settle(goal: Goal, before: Option[Move]): Future[Unit] =
    def watch(looks: Int, good: Int): Future[Unit] = look().flatMap: state =>
      val stays = if goal.isHeld(state) then good + 1 else 0
      calledOff() match
        case Some(why)                  => Future.failed(CannotFly(why))
        case None if stays == GoodLooks => Future.unit
        case None if looks == 1         => steer(goal, None)
        case None                       => after(Every.toDuration)(watch(looks - 1, stays))
    park(before).flatMap(_ => watch(Looks, 0))

  /** Commands the vehicle to hover, and waits for the end of its last move and for this answer. */
  private def park(before: Option[Move]): Future[Unit] =
    val hover = replaced(Some(vehicle.hover()))
    replaced(before).transformWith(moved => hover.transform(hangs => moved.flatMap(_ => hangs)))

  private def replaced(move: Option[Move]): Future[Unit] =
    move.fold(Future.unit)(CannotFly.unless(_)(_.message).map(_ => ()))

  private def look(): Future[Kinematics] =
    truth.fold(CannotFly.unless(vehicle.read())(_.message).map(_.value))(_())

private[flight] object Approach:
  private type Move = Future[Either[VehicleError, Boolean]]

  /** Tolerances of an arrival: distance from the goal, speed, and deviation of the yaw from north. */
  final case class Limits(off: Metres, speed: MetresPerSecond, yaw: Radians)

  private final case class Goal(placeNed: Vector3, limits: Limits, until: Instant):
    def isHeld(state: Kinematics): Boolean =
      (state.positionNed - placeNed).norm <= limits.off.value &&
        state.velocityNed.norm <= limits.speed.value &&
        math.abs(state.orientation.yawRad) <= limits.yaw.value

  val Passing: Limits = Limits(Metres(1), MetresPerSecond(0.5), Radians(math.toRadians(10)))

  /** Limits at a start. A flight may begin 0.3 m off and at 0.1 m/s; a hover moves a little more before it
    * settles.
    */
  val AtRest: Limits = Limits(Metres(0.15), MetresPerSecond(0.05), Radians(math.toRadians(3)))

  private val Cruise = MetresPerSecond(5)

  /** Duration of one command; if the next one never arrives, the vehicle hovers after it. */
  private val Lasts = Span.ofSeconds(1)

  private val Every = Span.ofMillis(100)

  /** Time allowed for the way, in addition to twice its duration at cruise speed. */
  private val Patience = Span.ofSeconds(40)

  /** Maximum number of readings of a hovering vehicle, and how many in a row must be within the tolerances.
    */
  private val Looks     = 40
  private val GoodLooks = 10
