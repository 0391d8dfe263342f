package skein.torture

import com.typesafe.config.{Config, ConfigFactory}
import java.nio.file.Files
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.airsim.*
import skein.flight.{Equipped, FlightRigs}
import skein.link.*
import skein.loop.*
import skein.record.{Flight as FlightRow, *}
import skein.rpc.RpcClient
import skein.scenario.PaperDuel
import skein.simulator.SimulatorSettings
import skein.units.*
import skein.vtime.VirtualTime

/** Flies a team through an [[Ordeal]] in virtual time. Client, link, server, simulator, loop and recorder are those of a
  * live flight; what is watched or spoilt is wrapped around them.
  */
object TortureFlight:

  /** Flies to the end on the calling thread. */
  def fly(ordeal: Ordeal): Evidence =
    VirtualTime
      .run(ordeal.seed, config = silent)(system => Assembly(ordeal)(using system).fly())
      .value

  private def writtenAndRead(memory: MemoryRecorder): Either[RecordError, Recording] =
    val folder = Files.createTempDirectory("torture")
    val file   = folder.resolve("flight.duckdb")
    try memory.writeTo(file).flatMap(_ => RecordingReader.read(file))
    finally
      Files.deleteIfExists(file): Unit
      Files.delete(folder)

  /** Broken connections are what this is about; nobody needs to be warned of each. */
  private val silent: Config = ConfigFactory
    .parseString("pekko { loglevel = OFF, stdout-loglevel = OFF }")
    .withFallback(ConfigFactory.load())

  private final class Assembly(ordeal: Ordeal)(using system: ActorSystem):
    import system.dispatcher

    private val clock    = Clock.ofNanos(VirtualTime.clock(system))
    private val scenario = ordeal.scenario.fleet
    private val start    = clock.now()
    private val faults   = LinkProfile
      .symmetric(ordeal.link)
      .copy(faults = Faults(ordeal.faults), cutsSegments = ordeal.cutsSegments)
    private val network = MemoryNetwork(
      NetworkPlan(links = Map(("controller", "simulator") -> faults)),
      ordeal.seed,
      clock,
      TortureFlight.connectTimeout
    )
    private val world = scenario.agents.map(agent =>
      VehicleSettings(agent.name, agent.startPositionNed.copy(z = 0), agent.startHeading)
    )
    private val address = Address("simulator", 41451)
    private val tap     = Wiretap(
      network.host("simulator"),
      ordeal.meddling,
      spared = "operator",
      ordeal.seed,
      clock,
      start + ordeal.calmFrom
    )
    private val operator = Operator(
      scenario,
      SimulatorSettings(
        WorldSettings(world, text = WorldSettings.render(world, ordeal.scenario.equipment)),
        address,
        scene = ordeal.scene.scene
      ),
      tap,
      network.host("operator"),
      clock
    )
    private val settings = FlightRigs.rpcSettings(ordeal.loop)
    private val rpc      = RpcClient(network.host("controller"), address, clock, settings, ordeal.seed)
    private val client   = AirSimClient(rpc, FlightRigs.askTimeout)
    private val memory   = MemoryRecorder(heading)
    private val recorder = FaultyRecorder(memory, ordeal.disk, clock, start)

    def fly(): Future[Evidence] =
      for
        vehicles <- operator.start(ordeal.clockAhead)
        asked = vehicles.zipWithIndex.map((vehicle, index) =>
          Multirotor(client, vehicle.name, vehicle.originNed, index)
        )
        multirotors = asked.map(vehicle =>
          AirSimVehicle(
            vehicle,
            lost => recorder.offer(Event(clock.now(), EventKind.TimedOut, Some(vehicle.name), lost))
          )
        )
        crafts = multirotors.zip(asked).map((craft, vehicle) =>
          WatchedVehicle(Equipped.by(ordeal.scenario, craft, vehicle), clock)
        )
        stepper      = WatchedTime(AirSimTime(client))
        loopSettings =
          if PaperDuel.isAsPublished(ordeal.scenario) then LoopSettings().asPublished else LoopSettings()
        team   = Team(scenario, crafts, clock, recorder, loopSettings)
        flight =
          Flight.start(ordeal.loop, team, Some(stepper), ordeal.duration, clock, recorder)
        _         = ordeal.stopAt.foreach(at => system.scheduler.scheduleOnce(at.toDuration)(flight.stop()))
        restarted = Future.traverse(ordeal.restarts)(restart =>
          at(restart.at)(operator.restart(restart))
        )
        pending = system.scheduler.scheduleAtFixedRate(0.seconds, 20.millis)(() => samplePending())
        outcome <- flight.outcome
        endedAt = clock.now()
        _       = pending.cancel()
        _      <- client.close()
        _      <- restarted
        _      <- at(restOf(endedAt))(Future.unit)
        before <- operator.positions(vehicles)
        _      <- after(Evidence.Watched.toDuration, system.scheduler)(Future.unit)
        later  <- operator.positions(vehicles)
        paused <- operator.isPaused()
        _      <- operator.stop()
      yield Evidence(
        ordeal,
        loopSettings.window,
        loopSettings.minCommandInterval,
        loopSettings.period,
        loopSettings.patience,
        start,
        endedAt,
        outcome,
        scenario.agents.map(_.name),
        crafts,
        tap.arrivals,
        tap.lastHovers,
        tap.mostUnanswered,
        mostPending,
        settings,
        rpc.stats,
        memory.recording,
        recorder.offered,
        Option.when(ordeal.isFiled)(writtenAndRead(memory)),
        operator.runs,
        before.zip(later).map((from, to) => Metres((to - from).norm)),
        stepper.calls,
        multirotors.map(_.callsBeside).sum,
        paused
      )

    private var mostPending = 0L

    private def samplePending(): Unit = mostPending = mostPending.max(rpc.stats.pending)

    /** When the vehicles must hover: soon, or where the command to hover may not have come through, after the last move
      * has lasted its time.
      */
    private def restOf(endedAt: Instant): Span =
      val ended = endedAt.since(start)
      if ended > ordeal.calmFrom + Ordeal.ResumesWithin then ended + TortureFlight.ComesToRest
      else ended.max(ordeal.calmFrom) + LoopSettings().moveDuration + TortureFlight.ComesToRest

    private def at[A](sinceStart: Span)(action: => Future[A]): Future[A] =
      after((start + sinceStart).since(clock.now()).max(Span.Zero).toDuration, system.scheduler)(action)

    private def heading = Heading(
      FlightRow(
        s"torture-${ordeal.seed}",
        ordeal.loop.label,
        ordeal.link.name,
        ordeal.seed,
        LoopSettings().period,
        ordeal.duration,
        "virtual",
        "built-in",
        "torture",
        "",
        start
      ),
      Seq.empty
    )

  private val connectTimeout = Span.ofSeconds(1)

  /** From 10 m/s to a hover. A move still under way would fly on for longer than this and [[Evidence.Watched]]. */
  private val ComesToRest = Span.ofSeconds(5)
