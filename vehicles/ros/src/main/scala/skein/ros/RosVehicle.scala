package skein.ros

import org.apache.pekko.actor.{ActorSystem, Cancellable}
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Future, Promise}
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.ros.message.*
import skein.signal.{ClockAlignment, FastestMessage, Kinematics, Stamped}
import skein.units.{Clock, Instant, Span}

/** A vehicle behind ROS topics, as a loop's vehicle port: it is read by odometry, and steered by `cmd_vel` in
  * the frame of the odometry's pose, which is sent again every 50 ms. Once an action has ended, or replaced
  * by hovering, the velocity sent is zero. Not for real aircraft.
  *
  * A reading is the first odometry that arrives after the one read before. Its time is the header's stamp,
  * and the clocks are related by [[FastestMessage]].
  *
  * @param odometry the topic that it is read by, for messages
  * @param out takes commands
  */
final class RosVehicle private[ros] (
    name: String,
    odometry: String,
    out: TwistStamped => Unit,
    clock: Clock
)(using system: ActorSystem)
    extends VehiclePort:
  import RosVehicle.*
  import system.dispatcher

  private var newest    = Option.empty[Stamped[Kinematics]]
  private var isUnread  = false
  private var frame     = ""
  private var fastest   = Option.empty[FastestMessage]
  private var waiting   = Vector.empty[Promise[Either[VehicleError, Stamped[Kinematics]]]]
  private var flying    = Option.empty[Flying]
  private var alignment = Option.empty[ClockAlignment]
  private val first     = Promise[Unit]()

  /** Completes when the first odometry has been received. */
  private[ros] def isThere: Future[Unit] = first.future

  /** The clock of the headers relative to this process's clock, as known so far. */
  def clocks: Option[ClockAlignment] = synchronized(alignment)

  def read(): Future[Either[VehicleError, Stamped[Kinematics]]] = synchronized:
    newest match
      case Some(reading) if isUnread =>
        isUnread = false
        Future.successful(Right(reading))
      case _ =>
        val answer = Promise[Either[VehicleError, Stamped[Kinematics]]]()
        waiting = waiting :+ answer
        val late = system.scheduler.scheduleOnce(Patience):
          synchronized:
            waiting = waiting.filterNot(_ eq answer)
          answer.trySuccess(Left(VehicleError.TimedOut(
            s"$name: expected odometry on $odometry within ${Patience.toMillis} ms, none arrived"
          ))): Unit
        answer.future.onComplete(_ => late.cancel())
        answer.future

  def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] = synchronized:
    newest match
      case None =>
        Future.successful(Left(VehicleError.Unreachable(s"$name: no odometry has arrived on $odometry")))
      case Some(state) =>
        TwistCommand.of(action, state.value) match
          case Left(error)  => Future.successful(Left(error))
          case Right(twist) =>
            val next = Flying(action, clock.now() + lasts, Promise())
            flying.foreach(_.ended.trySuccess(Right(false)))
            flying = Some(next)
            send(twist)
            next.ended.future

  /** Answers as soon as zero velocity is sent. */
  def hover(): Future[Either[VehicleError, Boolean]] =
    synchronized:
      flying.foreach(_.ended.trySuccess(Right(false)))
      flying = None
      for state <- newest; twist <- TwistCommand.of(Action.Hover, state.value) do send(twist)
    Future.successful(Right(true))

  /** Takes odometry. Left says which values are not a motion. */
  private[ros] def receive(message: Odometry): Either[String, Unit] =
    TwistCommand.kinematics(message).map: kinematics =>
      val (validAt, now) = (message.header.stamp.instant, clock.now())
      val answered       = synchronized:
        val clocks  = fastest.fold(FastestMessage(now.since(validAt), now))(_.updated(validAt, now))
        val reading = Stamped(kinematics, validAt, clocks.sentAt(validAt, now), now)
        fastest = Some(clocks)
        alignment = Some(alignment.fold(ClockAlignment.of(reading))(_.updated(reading)))
        frame = message.header.frameId
        newest = Some(reading)
        isUnread = waiting.isEmpty
        val those = waiting
        waiting = Vector.empty
        those.map((_, reading))
      for (answer, reading) <- answered do answer.trySuccess(Right(reading))
      first.trySuccess(()): Unit

  /** Sends the velocity again, by the newest motion. */
  private def tick(): Unit = synchronized:
    for one <- flying if clock.now() >= one.until do
      flying = None
      one.ended.trySuccess(Right(true)): Unit
    val action = flying.fold(Action.Hover)(_.action)
    for state <- newest if hasFlown; twist <- TwistCommand.of(action, state.value) do send(twist)

  private var hasFlown = false

  private def send(twist: Twist): Unit =
    hasFlown = true
    out(TwistStamped(Header(Time.of(stamp), frame), twist))

  /** The present time, on the clock of the headers. */
  private def stamp: Instant = clock.now() - fastest.fold(Span.Zero)(_.offset)

  private val ticking: Cancellable =
    system.scheduler.scheduleWithFixedDelay(TwistCommand.Every.toDuration, TwistCommand.Every.toDuration)(
      () =>
        tick()
    )

  /** Lets a vehicle that was commanded hover, and ends every unanswered call. */
  private[ros] def close(): Unit =
    ticking.cancel(): Unit
    if synchronized(hasFlown) then hover(): Unit
    synchronized:
      waiting.foreach(_.trySuccess(Left(VehicleError.Cancelled(s"$name: the node was closed"))))
      waiting = Vector.empty

object RosVehicle:
  private final case class Flying(
      action: Action,
      until: Instant,
      ended: Promise[Either[VehicleError, Boolean]]
  )

  private val Patience = 1.second

  /** Opens the topics `/NAME/odom` and `/NAME/cmd_vel` of a vehicle; ROS's remapping gives them other names.
    *
    * @return Left if a topic cannot be opened
    */
  def open(node: RosNode, name: String, clock: Clock)(using ActorSystem): Either[String, RosVehicle] =
    val odometry = s"/$name/odom"
    for
      out <- node.publish[TwistStamped](s"/$name/cmd_vel")
      vehicle = RosVehicle(name, odometry, out.publish, clock)
      _ <-
        node.subscribe[Odometry](odometry)(it => vehicle.receive(it).left.foreach(node.refuse(odometry, _)))
    yield vehicle
