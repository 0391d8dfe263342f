package skein.torture

import com.typesafe.config.{Config, ConfigFactory}
import java.nio.file.Files
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import scala.concurrent.duration.*
import scala.util.Using
import skein.airsim.*
import skein.flight.{AirSimFleet, CameraSensor, Equipped, VirtualFlights}
import skein.link.*
import skein.forward.Asking
import skein.loop.*
import skein.record.*
import skein.rpc.RpcClient
import skein.simulator.SimulatorSettings
import skein.units.*
import skein.vtime.VirtualTime

/** Runs a team through a [[FaultPlan]] in virtual time. Client, link, server, simulator, loop and recorder
  * are those of a live flight; observers and faults are wrapped around them.
  */
object TortureFlight:

  def fly(faultPlan: FaultPlan): FlightTrace =
    VirtualTime
      .run(faultPlan.seed, VirtualFlights.limitsOf(faultPlan.loop, faultPlan.duration), silent)(system =>
        Assembly(faultPlan)(using system).fly()
      )
      .value

  private def writtenAndRead(memory: MemoryRecorder): Either[RecordError, Recording] =
    val folder = Files.createTempDirectory("torture")
    val file   = folder.resolve("flight.duckdb")
    try memory.writeTo(file).flatMap(_ => RecordingReader.read(file))
    finally
      // A write that fails may leave other files.
      Using.resource(Files.list(folder))(_.forEach(Files.delete(_)))
      Files.delete(folder)

  /** Suppresses warnings: broken connections are expected here. */
  private val silent: Config = ConfigFactory
    .parseString("pekko { loglevel = OFF, stdout-loglevel = OFF }")
    .withFallback(ConfigFactory.load())

  private final class Assembly(faultPlan: FaultPlan)(using system: ActorSystem):
    import system.dispatcher

    private val clock    = Clock.ofNanos(VirtualTime.clock(system))
    private val scenario = faultPlan.scenario.fleet
    private val start    = clock.now()
    private val faults   = LinkProfile
      .symmetric(faultPlan.link)
      .copy(faults = Faults(faultPlan.faults), cutsSegments = faultPlan.cutsSegments)
    private val network = MemoryNetwork(
      NetworkPlan(links = Map(("controller", "simulator") -> faults)),
      faultPlan.seed,
      clock,
      TortureFlight.connectTimeout
    )
    private val world   = scenario.agents.map(Vehicles.settings)
    private val address = Address("simulator", 41451)
    private val tap     = FaultyTransport(
      network.host("simulator"),
      faultPlan.messageFaults,
      spared = "supervisor",
      faultPlan.seed,
      clock,
      start + faultPlan.calmFrom
    )
    private val supervisor = SimulatorSupervisor(
      scenario,
      SimulatorSettings(
        WorldSettings.of(world, faultPlan.scenario.equipment),
        address,
        scene = faultPlan.scene.scene
      ),
      tap,
      network.host("supervisor"),
      clock
    )
    private val settings = AirSimFleet.rpcSettings(faultPlan.loop)
    private val rpc      = RpcClient(network.host("controller"), address, clock, settings, faultPlan.seed)
    private val client   = AirSimClient(rpc, Asking.Timeout)
    private val memory   = MemoryRecorder(heading)
    private val recorder = FaultyRecorder(memory, faultPlan.disk, clock, start)

    def fly(): Future[FlightTrace] =
      for
        vehicles <- supervisor.start(faultPlan.clockAhead)
        asked = vehicles.zipWithIndex.map((vehicle, index) =>
          Multirotor(client, vehicle.name, vehicle.originNed, index)
        )
        multirotors = asked.map(vehicle =>
          AirSimVehicle(
            vehicle,
            lost => recorder.offer(Event(clock.now(), EventKind.TimedOut, Some(vehicle.name), lost))
          )
        )
        eyes = asked.flatMap(look)
        // The policies' cameras; while the simulator stands still, each reading takes an image.
        sensors = eyes.map(one =>
          (one.eye.vehicle, one.eye.sensor, if isPaused then one.looking else one.sensor)
        )
        ports = multirotors.zip(asked).map((port, vehicle) =>
          val seen = sensors.collect { case (vehicle.name, name, sensor) => name -> sensor }
          WatchedVehicle(Equipped.by(faultPlan.scenario, port, vehicle), clock, seen.toMap)
        )
        _            = if !isPaused then eyes.foreach(_.run())
        stepper      = WatchedTime(AirSimTime(client))
        loopSettings =
          if faultPlan.scenario.isAsPublished then LoopSettings().asPublished else LoopSettings()
        team   = Team(scenario, ports, clock, recorder, loopSettings)
        flight =
          Flight.start(faultPlan.loop, team, Some(stepper), faultPlan.duration, clock, recorder)
        _ = faultPlan.stopAt.foreach(at => system.scheduler.scheduleOnce(at.toDuration)(flight.stop()))
        restarted = Future.traverse(faultPlan.restarts)(restart =>
          at(restart.at)(supervisor.restart(restart))
        )
        pending = system.scheduler.scheduleAtFixedRate(0.seconds, 20.millis)(() => samplePending())
        outcome <- flight.outcome
        endedAt = clock.now()
        _       = pending.cancel()
        _ <-
          if isPaused then Future.unit else Future.traverse(eyes)(eye => eye.close().flatMap(_ => eye.ended))
        _      <- client.close()
        _      <- restarted
        _      <- at(restOf(endedAt))(Future.unit)
        before <- supervisor.positions(vehicles)
        _      <- after(FlightTrace.Watched.toDuration, system.scheduler)(Future.unit)
        later  <- supervisor.positions(vehicles)
        paused <- supervisor.isPaused()
        _      <- supervisor.stop()
      yield FlightTrace(
        faultPlan,
        loopSettings,
        start,
        endedAt,
        outcome,
        ports,
        tap.arrivals,
        tap.lastHovers,
        tap.mostUnanswered,
        mostPending,
        rpc.stats,
        memory.recording,
        recorder.offered,
        Option.when(faultPlan.isFiled)(writtenAndRead(memory)),
        supervisor.runs,
        before.zip(later).map((from, to) => Metres((to - from).norm)),
        stepper.calls,
        multirotors.map(_.callsBeside).sum,
        paused,
        eyes.map(_.counts)
      )

    private def isPaused = faultPlan.loop == LoopKind.Paused

    private def look(vehicle: Multirotor): Vector[CameraSensor] =
      faultPlan.eyes.filter(_.vehicle == vehicle.name).map: eye =>
        CameraSensor(
          eye,
          vehicle.eyes,
          faultPlan.seed,
          clock,
          (kind, detail) => recorder.offer(Event(clock.now(), kind, Some(vehicle.name), detail))
        )

    private var mostPending = 0L

    private def samplePending(): Unit = mostPending = mostPending.max(rpc.stats.pending)

    private def restOf(endedAt: Instant): Span =
      val ended = endedAt.since(start)
      if ended > faultPlan.calmFrom + FaultPlan.ResumesWithin then ended + TortureFlight.ComesToRest
      else ended.max(faultPlan.calmFrom) + LoopSettings().moveDuration + TortureFlight.ComesToRest

    private def at[A](sinceStart: Span)(action: => Future[A]): Future[A] =
      after((start + sinceStart).since(clock.now()).max(Span.Zero).toDuration, system.scheduler)(action)

    private def heading = RecordingHeader(
      FlightRow(
        s"torture-${faultPlan.seed}",
        faultPlan.loop.label,
        faultPlan.link.name,
        faultPlan.seed,
        LoopSettings().period,
        faultPlan.duration,
        "virtual",
        Simulator.BuiltIn,
        "torture",
        "",
        start
      ),
      Seq.empty
    )

  private val connectTimeout = Span.ofSeconds(1)

  /** Time to stop from 10 m/s. A move that is still in effect would last longer than this and
    * [[FlightTrace.Watched]].
    */
  private val ComesToRest = Span.ofSeconds(5)
