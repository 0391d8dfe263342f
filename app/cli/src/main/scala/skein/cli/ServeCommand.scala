package skein.cli

import mainargs.{Flag, ParserForClass, arg}
import scala.concurrent.duration.DurationInt
import scala.concurrent.{ExecutionContext, Promise}
import skein.airsim.WorldSettings
import skein.hil.AutopilotKind
import skein.link.{Address, ControlThreads, TcpTransport}
import skein.settings.{NamedScene, SimulatedBody, TextFile}
import skein.report.TextTable
import skein.simulator.{
  HilSettings,
  MavlinkSettings,
  Overload,
  SettingsFile,
  SimulatedSensing,
  SimulatorServer,
  SimulatorSettings
}
import skein.units.{Clock, Expect, Span}
import skein.vehicle.{PathFollowing, SensorNoise}
import skein.view.Shows

/** Command-line options of `./skein serve`, with their help texts. */
final case class ServeOptions(
    @arg(doc =
      "where it listens; 0.0.0.0 opens it to other machines " +
        "(default: 127.0.0.1, at ApiServerPort of the settings, or else 41451)"
    )
    listen: Option[String],
    @arg(doc = "an AirSim settings.json with the vehicles; without it, one named SimpleFlight")
    settings: Option[String],
    @arg(doc =
      "workers of the server, each held by a move until it ends, as " +
        "AirSim's are, for 30 s in all: a number, vehicles+4, or unlimited"
    )
    workers: String = "vehicles+4",
    @arg(doc = "speed of the simulator's clock, relative to the machine's")
    speed: Double = 1.0,
    @arg(doc = "scene: empty, forest, pursuit, street, or a file")
    scene: String = "empty",
    @arg(doc =
      "model that flies: airsim, airsim:DEVIATION such as airsim:mass=1.3,drag=2,wind=8/0/0, or mujoco:FILE"
    )
    plant: String = "airsim",
    @arg(doc =
      "errors of readings, such as position=0.1,dropout=2%: position, velocity, heading (standard deviations in m, " +
        "m/s, rad), drift=1.5/60s (of the position, slowly varying), dropout, outage=1s/20s"
    )
    sensors: Option[String],
    @arg(doc = "seed of every random choice, which are gusts and errors of readings")
    seed: Long = 1,
    @arg(doc =
      "speaks MAVLink too, as PX4's simulation does: UDP to 14550 for a ground station, and to " +
        "14540, 14541, … for programs, one port for each vehicle; all vehicles also at UDP 18570"
    )
    mavlink: Flag,
    @arg(
      name = "mavlink-instance",
      doc =
        "for a second serve --mavlink: the instance number of the first vehicle, as PX4's -i, " +
          "which is added to ports and system numbers (default: 0)"
    )
    mavlinkInstance: Option[Int],
    @arg(doc =
      "makes the vehicles part of ROS 2, which must be installed: /NAME/odom, /NAME/imu, images, scans, /tf and " +
        "/clock go out, /NAME/cmd_vel and /NAME/setpoint_pose fly them"
    )
    ros: Flag,
    @arg(
      name = "ros-step",
      doc =
        "with --ros: the clock waits for nodes; once a vehicle is commanded, it stops this often, a multiple of 20ms, " +
          "until each vehicle that is flown has a command stamped then or later; nodes need use_sim_time"
    )
    rosStep: Option[String],
    @arg(doc =
      "lets an external autopilot fly each vehicle: px4 (TCP 4560, 4561, …, in lockstep), " +
        "ardupilot (JSON, UDP 9002, 9012, …) or betaflight (UDP 9002, one vehicle)"
    )
    hil: Option[String],
    view: ViewOptions
)

/** `./skein serve`: runs the built-in simulator until Ctrl-C. */
object ServeCommand
    extends Command[ServeOptions](
      "serve",
      "runs the built-in simulator, which speaks AirSim's protocol",
      ParserForClass[ServeOptions]
    ):

  /** Maximum speed accepted; no machine simulates faster. */
  private val MostSpeed = 1000.0

  protected def execute(options: ServeOptions): Either[String, Unit] =
    for
      overload <- overloadOf(options.workers)
      _        <- Expect.that(options.speed > 0 && options.speed <= MostSpeed):
        s"--speed: expected more than 0 and up to ${MostSpeed.toInt}, got ${options.speed}"
      file <- options.settings.fold(Right(SettingsFile(WorldSettings.Default, Vector.empty)))(fileOf)
      world = file.world
      address   <- addressOf(options.listen, world)
      scene     <- NamedScene.read(options.scene).left.map("--scene: " + _)
      plant     <- SimulatedBody.parse(options.plant).left.map("--plant: " + _)
      kind      <- plant.kind(options.seed)
      autopilot <- Expect.optional(options.hil)(autopilotOf)
      _         <- Expect.that(autopilot.isEmpty || !options.mavlink.value):
        "--hil: not together with --mavlink, which is an autopilot itself"
      noise <-
        Expect.optional(options.sensors)(SensorNoise.parse).left.map("--sensors: " + _)
      _ <- Expect.that(noise.isEmpty || autopilot.isEmpty):
        "--sensors: not together with --hil, whose autopilots have sensors of their own"
      _ <- autopilot.flatMap(_ => plant.refusesAutopilots).map("--plant: " + _).toLeft(())
      _ <- Expect.that(!options.ros.value || autopilot.isEmpty && !options.mavlink.value):
        "--ros: not together with --mavlink or --hil, which fly the vehicles themselves"
      step <- Expect.optional(options.rosStep)(stepOf)
      _    <- Expect.that(step.isEmpty || options.ros.value)("--ros-step: expected together with --ros")
      flies = if options.ros.value then "--ros" else if autopilot.isDefined then "--hil" else "--mavlink"
      other = world.vehicles.find(vehicle => vehicle.isCar || vehicle.isCamera)
      _ <- Expect.that(autopilot.isEmpty && !options.mavlink.value && !options.ros.value || other.isEmpty):
        s"$flies: expected multirotors alone, got ${other.fold("")(it =>
            s"the ${if it.isCar then "car" else "camera"} ${it.name}"
          )}"
      _ <- Expect.that(options.mavlinkInstance.isEmpty || options.mavlink.value):
        "--mavlink-instance: expected together with --mavlink"
      instance     = options.mavlinkInstance.getOrElse(0)
      mostInstance = MavlinkSettings.MostSystems - world.vehicles.size
      _ <- Expect.that(!options.mavlink.value || instance >= 0 && instance <= mostInstance):
        s"--mavlink-instance: expected 0 to $mostInstance, got $instance"
      mavlink =
        Option.when(options.mavlink.value)(MavlinkSettings.asPx4(world.vehicles.size, address.host, instance))
      hil   = autopilot.map(HilSettings.usual(_, world.vehicles.size, address.host))
      shows = Shows()
      ros <-
        if options.ros.value then
          RosSide.open(world.vehicles.map(_.name)).left.map("--ros: " + _).map(Some(_))
        else Right(None)
      _ <- options.view.serving(shows)(
        serve(
          SimulatorSettings(
            world,
            address,
            overload,
            options.speed,
            scene = scene.scene,
            mavlink = mavlink,
            hil = hil,
            kind = kind,
            patience = Some(Patience),
            sensing = noise.map(SimulatedSensing(_, options.seed))
          ),
          Option.when(options.view.view.value)(shows),
          ros,
          step,
          file.notice.map(notice => s"${options.settings.getOrElse("")}: $notice")
        )
      )
    yield ()

  /** Listening address: the command line's, else this machine's at the settings' port. */
  private[cli] def addressOf(listen: Option[String], world: WorldSettings): Either[String, Address] =
    listen match
      case Some(named) => Address.parse(named).left.map("--listen: " + _)
      case None        => Right(Address("127.0.0.1", world.apiPort.getOrElse(SimulatorSettings.UsualPort)))

  private def overloadOf(text: String): Either[String, Overload] = text match
    case "vehicles+4" => Right(Overload.AirSim)
    case "unlimited"  => Right(Overload.Never)
    case number       =>
      number.toIntOption
        .filter(_ > 0)
        .map(Overload.Workers(_))
        .toRight(s"--workers: expected a number, vehicles+4 or unlimited, got '$number'")

  private def autopilotOf(label: String): Either[String, AutopilotKind] =
    AutopilotKind.values
      .find(_.label == label)
      .toRight(s"--hil: expected ${AutopilotKind.values.map(_.label).mkString(", ")}, got '$label'")

  private def stepOf(text: String): Either[String, Span] =
    for
      step <- Span.parse(text).left.map("--ros-step: " + _)
      _    <- Expect.that(step > Span.Zero && step.toNanos % StepsOf.toNanos == 0):
        s"--ros-step: expected a multiple of ${StepsOf.toMillis.toInt}ms, got $text"
    yield step

  private[cli] def fileOf(name: String): Either[String, SettingsFile] =
    for
      text <- TextFile.read(name)
      file <- SettingsFile.read(text).left.map(error => s"$name: ${error.message}")
    yield file

  private def serve(
      settings: SimulatorSettings,
      shows: Option[Shows],
      ros: Option[RosSide],
      step: Option[Span],
      notice: Option[String]
  ): Either[String, Unit] =
    Edge.withSystem("skein"): system ?=>
      try
        val server =
          Edge.await(SimulatorServer.start(settings, TcpTransport(), Clock.system, ros.map(_.topics), step))
        ros.foreach(_.fly(server, settings.world))
        val vehicles =
          settings.world.vehicles.map(vehicle => TextTable.printable(vehicle.name)).mkString(", ")
        val mavlink = settings.mavlink.fold(""): open =>
          s", and by MAVLink from UDP ports ${open.udp.map(port =>
              s"${port.at.port}${port.tells.fold("")(to => s" to $to")}"
            ).mkString(", ")}"
        val hil = settings.hil.fold(""): open =>
          s", for ${open.autopilot.label} at ${server.peerAddresses.mkString(", ")}"
        val ofRos = ros.fold("")(_ => ", and to ROS 2")
        Console.out.println(s"serving $vehicles at ${server.address}$mavlink$hil$ofRos; Ctrl-C ends it")
        notice.foreach(line => Console.out.println(line))
        val ended = Promise[Either[String, Unit]]()
        server.failed.foreach(failure =>
          ended.trySuccess(
            Left(s"the simulator at ${server.address} has failed and closed its port: $failure")
          )
        )(using ExecutionContext.parasitic)
        val telling =
          system.scheduler.scheduleWithFixedDelay(NewsEvery, NewsEvery)(tellNews(server, settings, ros))(using
            system.dispatcher
          )
        // The code it runs is compiled by then.
        val leading =
          system.scheduler.scheduleOnce(LeadsAfter)(ControlThreads.lead(): Unit)(using system.dispatcher)
        val shown   = shows.map(TruthOnShow.start(settings, server, _, Clock.system))
        val outcome = Edge.untilInterrupted(() => ended.trySuccess(Right(())): Unit, GraceMillis)(
          Edge.await(ended.future)
        )
        telling.cancel()
        leading.cancel()
        shown.foreach(_.cancel())
        Edge.await(server.close())
        outcome
      finally ros.foreach(_.close())

  /** Time for which clients' moves may hold all workers, as in AirSim. */
  private val Patience = Span.ofSeconds(30)

  /** Time within which it ends, whatever the simulation does. */
  private val GraceMillis = 2_000L

  /** Time between two messages of the simulator's clock. */
  private val StepsOf = PathFollowing.Period

  private val NewsEvery  = 10.seconds
  private val LeadsAfter = 10.seconds

  /** Prints newly refused requests of clients, as they occur. */
  private def tellNews(server: SimulatorServer, settings: SimulatorSettings, ros: Option[RosSide]) =
    new Runnable:
      private var told   = Option.empty[String]
      private val called = settings.hil.fold("MAVLink")(_.autopilot.label)
      def run(): Unit    =
        val news = ServerNews.line(server.stats, settings.limits, server.peerStats, called, server.hasHeldUp)
        if news != told then
          told = news
          news.foreach(Console.out.println)
        ros.foreach(_.news().foreach(line => Console.out.println(line)))
