package skein.flight

import java.io.{PrintWriter, StringWriter}
import java.nio.file.Path
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.link.{Address, LinkProfile, MemoryNetwork, NetworkPlan}
import skein.loop.{AnyLoop, FlightOutcome, LoopKind}
import skein.measure.RecordedTracks
import skein.units.OwnFailure
import skein.record.{Digest, MemoryRecorder}
import skein.scenario.{Result, Scenario, Tracks}
import skein.settings.{FlightPlan, FlySettings, RecordedPlan, SolverChoice}
import skein.signal.LatencyProfile
import skein.solver.{FlightDeciders, SolverDesk, SolverServer, TcpLink}
import skein.units.*
import skein.vtime.{Problem, RunLimits, VirtualTime, VirtualTimeException}

/** Flights in virtual time: the same simulator, link, client and loop as live, with the clock, the scheduler
  * and the sockets replaced. Equal settings and plans give equal recordings, byte for byte.
  */
object VirtualFlights:

  /** Flies all, as many at once as there are cores, and writes a recording of each into `folder`. Blocks.
    *
    * @param onLanded called with each flight as it has ended, and with the digest of its recording
    * @return or which of them could not be flown, and why; the recordings of the others are written
    */
  def fly(settings: FlySettings, plans: Vector[FlightPlan], folder: Path)(
      onLanded: (FlightResult, Digest) => Unit
  ): Either[String, Vector[FlightResult]] =
    val (missing, landed) = inParallel(settings, plans): flown =>
      val landed = flown.landed.copy(written = flown.recorder.writeTo(flown.landed.plan.file(folder)))
      onLanded(landed, flown.recorder.digest)
      landed
    .partitionMap(identity)
    Either.cond(missing.isEmpty, landed, NotFlown.message(missing, plans.size))

  /** Flies all, as many at once as there are cores, and keeps of each what `use` makes of it. Blocks.
    *
    * @return one for each plan, in their order
    */
  def inParallel[A](settings: FlySettings, plans: Vector[FlightPlan])(
      use: VirtualFlightResult => A
  ): Vector[Either[NotFlown, A]] =
    eachInParallel(plans)(plan => fly(settings, plan).map(use))

  /** Whatever ends one flight, it is told with that flight's seed, and the others are flown. */
  private[skein] def eachInParallel[A](plans: Vector[FlightPlan])(
      fly: FlightPlan => Either[String, A]
  ): Vector[Either[NotFlown, A]] =
    def flown(plan: FlightPlan) =
      val result =
        try fly(plan)
        catch case error: Throwable => Left(NotFlown.trace(error))
      result.left.map(NotFlown(plan, _))
    InParallel.map(plans, Runtime.getRuntime.availableProcessors)(flown)

  /** Flies on the calling thread, to the end.
    *
    * @return how it ended and what was recorded, or why it could not be flown
    */
  def fly(settings: FlySettings, plan: FlightPlan): Either[String, VirtualFlightResult] =
    fly(settings, plan, RunLimits())

  /** @param limits of a flight in which time goes on */
  private[flight] def fly(
      settings: FlySettings,
      plan: FlightPlan,
      limits: RunLimits
  ): Either[String, VirtualFlightResult] =
    VirtualTime
      .run(plan.seed, limitsOf(plan.loop, settings.duration, limits)): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock     = Clock.ofNanos(VirtualTime.clock(system))
        val behind    = plan.solver.collect { case SolverChoice.Link(profile) => profile }
        val links     = behind.map(profile => (Here, There) -> LinkProfile.symmetric(profile)).toMap
        val network   = MemoryNetwork(NetworkPlan(links = links), plan.seed, clock)
        val assembler = FlightAssembler(
          network.host(Here),
          clock,
          settings,
          simulator = None,
          FlightAssembler.counted,
          learnsOn = Some(system.dispatcher),
          solvers = Solvers(
            Here,
            {
              case SolverChoice.Link(_) => Right(TcpLink(network.host(Here), SolverAt))
              case _                    => Left("virtual time knows link:PROFILE alone")
            }
          )
        )
        val recorder = MemoryRecorder(assembler.heading(plan, clockKind = "virtual"))
        val serving  = if behind.isEmpty then Future.unit else serveSolver(settings, plan, network, clock)
        serving
          .flatMap(_ => assembler.start(plan, recorder))
          .flatMap:
            case Left(reason)    => Future.successful(Left(reason))
            case Right(assembly) =>
              assembly.landed.map(landed => Right(VirtualFlightResult(landed, recorder)))
      .value

  /** A paused flight without delays passes in one instant: as much more may run in it as it flies longer. */
  private[skein] def limitsOf(loop: AnyLoop, duration: Span, limits: RunLimits = RunLimits()): RunLimits =
    if loop != LoopKind.Paused then limits
    else
      val seconds = duration.toSeconds.ceil.toLong
      limits.copy(
        tasksPerInstant = limits.tasksPerInstant + TasksPerSecond * seconds,
        processorPerInstant = limits.processorPerInstant + ProcessorPerSecond * seconds
      )

  /** A team of 64 that is asked and commanded ten times a second has a tenth of this. */
  private val TasksPerSecond = 100_000L

  private val ProcessorPerSecond = 10.seconds

  /** What one flight of a scenario comes to, by itself. Flies on the calling thread.
    *
    * @param duration at most; 0 for the scenario's own
    * @return or why it could not be flown to its end, or its vehicles were not all seen
    */
  def result(
      scenario: Scenario,
      loop: AnyLoop,
      link: LatencyProfile,
      seed: Long,
      period: Span = Span.ofMillis(100),
      duration: Span = Span.Zero
  ): Either[String, Result] =
    val most = if duration == Span.Zero then scenario.duration else duration
    result(FlySettings(List(loop), List(link), most, period, seed, scenario))

  /** What the last flight of these settings comes to, likewise. */
  def result(settings: FlySettings): Either[String, Result] =
    for
      flown <- fly(settings, settings.plans.last.copy(seed = settings.seed))
      _     <- flown.landed.outcome match
        case FlightOutcome.Failed(reason) => Left(reason)
        case _                            => Right(())
      tracks <- Tracks
        .of(RecordedTracks.of(flown.recorder.recording))
        .filter(_.vehicles.size == settings.fleet.agents.size)
        .toRight("its vehicles were not all seen")
    yield Result.of(settings.scenario, tracks)

  private def serveSolver(settings: FlySettings, plan: FlightPlan, network: MemoryNetwork, clock: Clock)(using
      system: ActorSystem
  ): Future[SolverServer] =
    def deciders = FlightDeciders.of(RecordedPlan(settings, plan), FlightAssembler.counted)
    val desk     = SolverDesk(plan.seed, Here, _ => deciders, clock, system.dispatcher)
    SolverServer.start(SolverAt, network.host(There), desk, clock)

  private val Here     = "localhost"
  private val There    = "solver"
  private val SolverAt = Address(There, 7400)

/** A flight in virtual time and all that was recorded of it. */
final case class VirtualFlightResult(landed: FlightResult, recorder: MemoryRecorder)

/** A flight in virtual time that could not be flown to its end, or not be used. */
final case class NotFlown(plan: FlightPlan, reason: String):
  def message: String = s"${plan.id}, seed ${plan.seed}: $reason"

object NotFlown:
  private val TraceLines = 30

  /** For a person, the last thing to be said. */
  def message(missing: Seq[NotFlown], planned: Int): String =
    (s"${missing.size} of $planned flights could not be flown:" +: missing.map(_.message)).mkString("\n")

  /** What the user can mend, in words: code of the user's own failed, or the program was started without
    * virtual time's agent, as development environments start it.
    */
  private[skein] def mendable(error: Throwable): Option[String] =
    OwnFailure.behind(error).map(_.getMessage).orElse:
      Iterator.iterate(error)(_.getCause).takeWhile(_ != null).collectFirst:
        case stopped: VirtualTimeException if stopped.problem.isInstanceOf[Problem.NoAgent] =>
          stopped.getMessage

  /** What was thrown and where, and what caused it; what the user can mend in words alone. */
  private[skein] def trace(error: Throwable): String = mendable(error) match
    case Some(reason) => reason
    case None         =>
      val text = StringWriter()
      error.printStackTrace(PrintWriter(text))
      text.toString.linesIterator.take(TraceLines).mkString("\n")
