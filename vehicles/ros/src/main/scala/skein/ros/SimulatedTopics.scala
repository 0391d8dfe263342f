package skein.ros

import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import java.util.concurrent.{ArrayBlockingQueue, TimeUnit}
import org.apache.pekko.actor.ActorSystem
import skein.airsim.WorldSettings
import skein.link.Address
import skein.ros.message.*
import skein.signal.Kinematics
import skein.policy.Action
import skein.simulator.{Onlooker, SeenVehicle, SimulatorServer}
import skein.units.{Expect, Instant, Span}

/** A simulator's vehicles as topics of a node. It publishes `/NAME/odom`, `/NAME/imu` and `/NAME/fix` of
  * each, `/tf` and, after these, `/clock`, every 20 ms of simulated time (`fix` every 200 ms). While the
  * simulator is paused, it repeats `/clock` every 100 ms. It takes `/NAME/cmd_vel`, `/NAME/cmd_vel_unstamped`
  * and `/NAME/setpoint_pose`.
  *
  * Messages are made and sent on a thread of its own. If it is too slow, the oldest motions are not
  * published, and counted.
  *
  * @param missing why some of the topics are not published: a package of ROS 2 that is not installed
  */
final class SimulatedTopics private (
    node: RosNode,
    clock: RosPublisher[Clock],
    vehicles: Vector[SimulatedTopics.Published],
    frames: Option[RosPublisher[TFMessage]],
    val missing: Vector[String]
) extends Onlooker
    with AutoCloseable:
  import SimulatedTopics.*

  private val queue              = ArrayBlockingQueue[(Instant, Vector[SeenVehicle])](MostWaiting)
  private val late               = AtomicLong()
  @volatile private var isClosed = false

  @volatile private var sensors = Option.empty[SimulatedSensors]

  /** Instants whose motions were not published, because the machine was too slow. */
  def skipped: Long = late.get

  /** Images and scans that were not published, because the machine was too slow. */
  def skippedImages: Long = sensors.fold(0L)(_.skipped)

  /** The first failure of each camera and lidar. */
  def notes: Vector[String] = sensors.fold(Vector.empty)(_.notes)

  /** Publishes images and scans of the simulator from now on: see [[SimulatedSensors]].
    *
    * @return Left if ROS 2 cannot publish them
    */
  def show(world: WorldSettings, simulator: Address)(using ActorSystem): Either[String, Unit] =
    SimulatedSensors
      .open(node, world, simulator, transform => frames.foreach(_.publish(TFMessage(Vector(transform)))))
      .map(opened => sensors = Some(opened))

  def see(at: Instant, seen: Vector[SeenVehicle]): Unit =
    while !queue.offer((at, seen)) do if queue.poll() != null then late.incrementAndGet(): Unit

  /** Lets the topics fly the simulator's vehicles from now on.
    *
    * @return Left if a topic cannot be subscribed to
    */
  def fly(server: SimulatorServer): Either[String, Unit] =
    Expect
      .each(vehicles.zipWithIndex): (vehicle, index) =>
        val name = vehicle.name
        def take(
            topic: String,
            header: Header,
            command: Either[String, Kinematics => Action],
            lasts: Option[Span]
        ): Unit =
          val stamp = Some(header.stamp.instant).filter(_ > Instant.Epoch)
          command match
            case Right(action) => server.act(index, action, lasts, stamp)
            case Left(why)     => node.refuse(s"/$name/$topic", why)
        def velocity(topic: String, header: Header, twist: Twist) =
          val command = VehicleCommands.velocity(name, header.frameId, twist)
          take(topic, header, command, Some(VehicleCommands.VelocityLasts))
        for
          _ <- node.subscribe[TwistStamped](s"/$name/cmd_vel")(it => velocity("cmd_vel", it.header, it.twist))
          _ <- node.subscribe[Twist](s"/$name/cmd_vel_unstamped")(
            velocity("cmd_vel_unstamped", Header(Time(0, 0), ""), _)
          )
          _ <- node.subscribe[PoseStamped](s"/$name/setpoint_pose")(it =>
            take("setpoint_pose", it.header, VehicleCommands.position(it), None)
          )
        yield ()
      .map(_ => ())

  private val thread = Thread.ofPlatform().daemon().name("skein-ros-out").start: () =>
    var last  = Option.empty[Instant]
    var fixAt = Instant.Epoch
    while !isClosed do
      queue.poll(RepeatMillis, TimeUnit.MILLISECONDS) match
        case null =>
          for at <- last do clock.publish(Clock(Time.of(at)))
        case (at, seen) =>
          val withFix = at >= fixAt
          if withFix then fixAt = at + FixEvery
          publish(at, seen, withFix)
          sensors.foreach(_.look(at))
          last = Some(at)

  private def publish(at: Instant, seen: Vector[SeenVehicle], withFix: Boolean): Unit =
    val published = seen.flatMap(vehicle => vehicles.find(_.name == vehicle.name).map((vehicle, _)))
    for (vehicle, topics) <- published do
      topics.odometry.foreach(_.publish(VehicleMessages.odometry(at, vehicle.name, vehicle.kinematics)))
      topics.imu.foreach(_.publish(VehicleMessages.imu(at, vehicle)))
      if withFix then topics.fix.foreach(_.publish(VehicleMessages.fix(at, vehicle)))
    frames.foreach(_.publish(TFMessage(published.map((vehicle, _) =>
      VehicleMessages.transform(at, vehicle.name, vehicle.kinematics)
    ))))
    clock.publish(Clock(Time.of(at)))

  /** Ends the thread that publishes; the node stays open. */
  def close(): Unit =
    isClosed = true
    thread.join(JoinMillis)
    sensors.foreach(_.close())

object SimulatedTopics:
  private final case class Published(
      name: String,
      odometry: Option[RosPublisher[Odometry]],
      imu: Option[RosPublisher[Imu]],
      fix: Option[RosPublisher[NavSatFix]]
  )

  /** Instants whose motions wait to be published: 1.3 s of simulated time. */
  private val MostWaiting = 64

  private val RepeatMillis = 100L
  private val FixEvery     = Span.ofMillis(200)
  private val JoinMillis   = 2_000L

  /** Opens the topics of vehicles with these names, in the simulator's order.
    *
    * @return Left if a name cannot be part of a topic's, or ROS 2 cannot publish
    */
  def open(node: RosNode, names: Vector[String]): Either[String, SimulatedTopics] =
    val missing = AtomicReference(Vector.empty[String])
    // A package that is not installed is named once, however many topics lack it.
    def unless[A](opened: Either[String, RosPublisher[A]]): Option[RosPublisher[A]] =
      opened.left.foreach(why =>
        missing.updateAndGet(all => if all.contains(why) then all else all :+ why): Unit
      )
      opened.toOption
    for
      _     <- mistake(names).toLeft(())
      clock <- node.publish[Clock]("/clock")
      vehicles = names.map: name =>
        Published(
          name,
          unless(node.publish[Odometry](s"/$name/odom")),
          unless(node.publish[Imu](s"/$name/imu")),
          unless(node.publish[NavSatFix](s"/$name/fix"))
        )
      frames = unless(node.publish[TFMessage]("/tf"))
    yield SimulatedTopics(node, clock, vehicles, frames, missing.get)

  /** Why vehicles with these names cannot have topics, if they cannot. */
  def mistake(names: Vector[String]): Option[String] =
    names.find(name => !name.matches("[A-Za-z][A-Za-z0-9_]*") || name.contains("__")).map: name =>
      s"expected vehicles' names of letters, digits and single _, with a letter first, got '$name'"
