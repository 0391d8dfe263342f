package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.airsim.*
import skein.link.*
import skein.forward.Asking
import skein.loop.{AnyLoop, LoopKind}
import skein.policy.Fleet
import skein.port.VehiclePort
import skein.record.*
import skein.rpc.{RpcClient, RpcEvent, RpcSettings}
import skein.settings.{FlightPlan, FlySettings}
import skein.signal.{LatencyProfile, SplitMix64}
import skein.units.*
import skein.units.Decimals.fixed
import skein.vehicle.SensorNoise

/** The vehicles of a flight in a simulator that speaks AirSim's wire protocol.
  *
  * @param address the simulator's
  * @param opened closes the connections
  * @param startsAirborne whether the simulator can place vehicles in the air; otherwise they climb to their
  *   starts
  * @param calledOff why the flight must be cancelled while its vehicles move to their starts, if so
  * @param isWatched whether images and clouds that are not recorded are still offered to the recorder
  * @param tell shows a line to the user
  */
private[flight] final class AirSimFleet(
    transport: Transport,
    clock: Clock,
    settings: FlySettings,
    plan: FlightPlan,
    address: Address,
    opened: Opened,
    monitor: FlightMonitor,
    startsAirborne: Boolean,
    calledOff: () => Option[String],
    isWatched: Boolean,
    tell: String => Unit
)(using system: ActorSystem):
  import system.dispatcher

  /** Brings the vehicles to their starts and connects them over the plan's link, or for each vehicle's own
    * controller over a link of its own.
    */
  def connect(): Future[ConnectedFleet] =
    for
      ready   <- prepare()
      clients <- lines.foldLeft(Future.successful(Vector.empty[AirSimClient])): (before, line) =>
        before.flatMap(clients => connected(line).map(clients :+ _))
      reached = clients.map: client =>
        ready.zipWithIndex.map((vehicle, index) =>
          // Altitudes count from each vehicle's start, as in its own frame.
          vehicle.over(client, vehicle.originNed.copy(z = 0), index)
        )
      vehicles = ready.indices.toVector.map(at => reached(settings.own.indexOf(at).max(0) % reached.size)(at))
      logs = vehicles.map(ImageRecorder(_, monitor, sensor => isWatched || settings.recordedImaging(sensor)))
      cameras = vehicles.zip(logs).map(look)
      films   = vehicles.zip(logs).flatMap(film)
      ports   = vehicles.zip(cameras).zip(logs).map: (looking, log) =>
        val (vehicle, eyes) = looking
        val isPaused        = plan.loop == LoopKind.Paused
        val seen = eyes.map(one => one.eye.sensor -> (if isPaused then one.looking else one.sensor))
        Equipped.by(settings.scenario, port(vehicle), vehicle, seen.toMap, log.scan)
      apart =
        if !settings.isDecentralised(plan) then Vector.empty
        else
          settings.own.zip(reached).map((self, seen) =>
            (self = self, vehicles = seen.map(port).updated(self, ports(self)))
          )
      _ <- if settings.world.isEmpty then Future.unit else watchContacts(vehicles)
      beside = opened.closing(
        AirSimClient(
          RpcClient(transport, address, clock, RpcSettings(controlConnections = 1)),
          Asking.Timeout
        )
      )(_.close())
      custody = Custody(
        vehicles.filter(one => settings.commands(one.name)).map(_.over(beside)),
        address,
        monitor.isLanding
      )
    yield ConnectedFleet(
      ports,
      Some(AirSimTime(clients.head)),
      address.toString,
      () => clients.head.ping().map(_.isRight),
      custody.ask,
      cameras.flatten,
      films,
      apart = apart
    )

  /** The link of the only controller, or of `vehicle`'s own controller. */
  private type Line = (vehicle: Option[String], seed: Long)

  private def lines: Vector[Line] =
    if !settings.isDecentralised(plan) then Vector((vehicle = None, seed = plan.seed))
    else
      settings.own.map(self =>
        (vehicle = Some(settings.fleet.agents(self).name), seed = SplitMix64.seedOf(plan.seed, self))
      )

  private def connected(line: Line): Future[AirSimClient] =
    between(line.seed).map: proxy =>
      val at = proxy.fold(address)(opened.closing(_)(_.close()).address)
      opened.closing(client(line, at))(_.close())

  private def port(vehicle: VehicleClient): VehiclePort =
    Vehicles.port(vehicle, note(EventKind.TimedOut, Some(vehicle.name), _))

  private def note(
      kind: EventKind,
      vehicle: Option[String],
      detail: String,
      about: Option[EventSubject] = None
  ): Unit = monitor.offer(Event(clock.now(), kind, vehicle, detail, about = about))

  /** The cameras of a vehicle that the scenario's recognisers use. */
  private def look(vehicle: VehicleClient, log: ImageRecorder): Vector[CameraSensor] =
    settings.scenario.eyes.filter(eye => eye.vehicle == vehicle.name && settings.commands(eye.vehicle)).map:
      eye =>
        if isWatched || settings.recordedImaging.nonEmpty then log.ask(eye.camera)
        CameraSensor(
          eye,
          vehicle.eyes,
          plan.seed,
          clock,
          note(_, Some(vehicle.name), _),
          log.image
        )

  /** The vehicle's cameras that are only filmed, not used by decisions. */
  private def film(vehicle: VehicleClient, log: ImageRecorder): Vector[FilmedCamera] =
    settings.filmed.filter(_.sensor.vehicle == vehicle.name).map: (sensor, every) =>
      log.ask(sensor.name)
      FilmedCamera(
        sensor.name,
        every,
        vehicle.eyes,
        clock,
        log.image,
        note(_, Some(vehicle.name), _, _),
        why => tell(s"${plan.id}: ${vehicle.name}'s camera $why")
      )

  private def watchContacts(vehicles: Vector[VehicleClient]): Future[Unit] =
    val client = AirSimClient(RpcClient(transport, address, clock), Asking.Timeout)
    opened.closing(ContactWatch(client, vehicles, settings.period, clock, monitor))(_.close()).start()

  /** Prepares the vehicles over a separate connection without the link: this is not part of the flight. */
  private def prepare(): Future[Vector[VehicleClient]] =
    val client      = AirSimClient(RpcClient(transport, address, clock))
    val preparation = Preparation(client, clock, calledOff, byTruth = settings.sensors.isDefined)
    val prepared    =
      if startsAirborne then preparation.place(settings.fleet)
      else preparation.climb(settings.fleet, address, settings.commands)
    CannotFly.unless(prepared.transformWith(result => client.close().transform(_ => result)))(identity)

  /** Starts the emulated link, if the flight has one. */
  private def between(seed: Long): Future[Option[LinkProxy]] =
    if plan.link == LatencyProfile.none then Future.successful(None)
    else
      val emulated = EmulatedLink(LinkProfile.symmetric(plan.link), seed, clock)
      LinkProxy.start(AirSimFleet.anyPort, address, emulated, transport).map(Some(_))

  private def client(line: Line, at: Address): AirSimClient =
    val rpc = RpcClient(
      transport,
      at,
      clock,
      AirSimFleet.rpcSettings(plan.loop),
      line.seed,
      event => AirSimFleet.eventOf(event).foreach((kind, detail) => note(kind, line.vehicle, detail))
    )
    AirSimClient(rpc, timeout = AirSimFleet.timeout(plan.loop))

/** Time-outs of AirSim's client, and the events of the client that a recording keeps. */
object AirSimFleet:
  /** Time-out of every request of a loop. While the simulator stands still readings do not age, so `paused`
    * waits longer.
    */
  private def timeout(loop: AnyLoop): Span =
    if loop == LoopKind.Paused then Span.ofSeconds(3) else Asking.Timeout

  /** Checks over a separate connection that the simulator has a fleet's vehicles, and readings with these
    * errors.
    *
    * @return Left says that it does not answer, or what it lacks
    */
  def missing(
      fleet: Fleet,
      sensors: Option[SensorNoise],
      at: Address,
      transport: Transport,
      clock: Clock
  )(using
      system: ActorSystem
  ): Future[Either[String, Unit]] =
    import system.dispatcher
    val rpc    = RpcClient(transport, at, clock, RpcSettings(controlConnections = 1))
    val client = AirSimClient(rpc, AirSimError.FirstWithin)
    val answer =
      for
        there  <- client.vehicles()
        errors <- client.sensors()
      yield there.flatMap(there => errors.map((there, _))) match
        case Left(error)            => Left(AirSimError.ofFirst(error, at))
        case Right((there, errors)) =>
          fleet.agents.map(_.name).filterNot(there.contains) match
            case Vector() => otherSensors(sensors, errors, at).toLeft(())
            case names    => Left(AirSimError.unknown(names, there))
    answer.flatMap(answer => client.close().map(_ => answer))

  private def otherSensors(ours: Option[SensorNoise], theirs: String, at: Address): Option[String] =
    def numbers(noise: SensorNoise) = noise.copy(text = "")
    val there                       = Option(theirs).filter(_.nonEmpty)
    Option.when(ours.map(numbers).map(Right(_)) != there.map(SensorNoise.parse(_).map(numbers))):
      s"--sensors: expected ${there.getOrElse("none")}, as in the simulator at $at, got ${ours.fold("none")(_.text)}"

  def rpcSettings(loop: AnyLoop): RpcSettings = loop match
    // Each command must reach the simulator before the step that follows it: one ordered connection.
    case LoopKind.Paused => RpcSettings(controlConnections = 1)
    case _               => RpcSettings()

  private val anyPort = Address("127.0.0.1", 0)

  /** The record of a client's event, if a recording keeps it; failed calls are recorded by their callers. */
  private def eventOf(event: RpcEvent): Option[(EventKind, String)] = event match
    case RpcEvent.Disconnected(lane, connection, reason) =>
      Some(EventKind.Disconnected -> s"$lane connection $connection: $reason")
    case RpcEvent.ConnectFailed(lane, connection, reason) =>
      Some(EventKind.Disconnected -> s"$lane connection $connection: $reason")
    case RpcEvent.LateReply(method, _, _, after) =>
      Some(EventKind.LateReply -> s"$method answered after ${after.toMillis.fixed(0)} ms")
    case _ => None
