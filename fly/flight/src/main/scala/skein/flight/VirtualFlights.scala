package skein.flight

import java.io.{PrintWriter, StringWriter}
import java.nio.file.Path
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.link.{Address, LinkProfile, MemoryNetwork, NetworkPlan}
import skein.loop.{AnyLoop, FlightOutcome, LoopKind}
import skein.measure.{FlightSummary, RecordedTracks}
import skein.units.OwnFailure
import skein.record.MemoryRecorder
import skein.scenario.{Result, Scenario, Scenarios, Tracks}
import skein.settings.{FlightPlan, FlySettings, RecordedPlan, SolverChoice}
import skein.signal.LatencyProfile
import skein.solver.{FlightDeciders, SolverDesk, SolverServer, TcpLink}
import skein.units.*
import skein.units.Decimals.brief
import skein.vtime.{Problem, RunLimits, VirtualTime, VirtualTimeException}

/** Flights in virtual time: the simulator, link, client and loop of live flights, with the clock, the
  * scheduler and the sockets replaced. Equal settings and plans give equal recordings, byte for byte.
  */
object VirtualFlights:

  /** Simulates all flights, in parallel on all cores, and writes a recording of each into `folder`. Blocks.
    *
    * @param onLanded called with each flight when it has ended, on its thread, and with its records
    * @return the flights that failed, and the others, whose recordings are written
    */
  def fly(settings: FlySettings, plans: Vector[FlightPlan], folder: Path)(
      onLanded: (FlightResult, MemoryRecorder) => Unit
  ): (missing: Vector[NotFlown], landed: Vector[FlightResult]) =
    val (missing, landed) = inParallel(settings, plans): flown =>
      val landed = flown.landed.copy(written = flown.recorder.writeTo(flown.landed.plan.file(folder)))
      onLanded(landed, flown.recorder)
      landed
    .partitionMap(identity)
    (missing, landed)

  /** Simulates all flights, in parallel on all cores, and keeps the result of `use` for each. Blocks.
    *
    * @return one for each plan, in their order
    */
  def inParallel[A](settings: FlySettings, plans: Vector[FlightPlan])(
      use: VirtualFlightResult => A
  ): Vector[Either[NotFlown, A]] =
    eachInParallel(plans)(plan => fly(settings, plan).map(use))

  /** [[inParallel]] for the flights' summaries, so that no recording is kept.
    *
    * @param use receives the summary of each flight, or why the flight failed
    */
  private[skein] def summaries[A](settings: FlySettings, plans: Vector[FlightPlan])(
      use: Either[NotFlown, FlightSummary] => Either[NotFlown, A]
  )(using Scenarios): Vector[Either[NotFlown, A]] =
    val used = inParallel(settings, plans): flight =>
      val completed = flight.completed.left.map(NotFlown(flight.landed.plan, _))
      use(completed.map(recorder => FlightSummary.of(recorder.recording)))
    used.map(_.flatten)

  /** Runs the flights in parallel. A failure is reported with that flight's seed, and the others still run.
    */
  private[skein] def eachInParallel[A](plans: Vector[FlightPlan])(
      fly: FlightPlan => Either[String, A]
  ): Vector[Either[NotFlown, A]] =
    def flown(plan: FlightPlan) =
      val result =
        try fly(plan)
        catch case error: Throwable => Left(NotFlown.trace(error))
      result.left.map(NotFlown(plan, _))
    InParallel.map(plans, Runtime.getRuntime.availableProcessors)(flown)

  /** The error message for flights whose records cannot fit into a [[MemoryRecorder]]. */
  def tooLong(settings: FlySettings): Option[String] =
    val vehicles = settings.fleet.agents.size
    val longest  = settings.period * (MemoryRecorder.defaultCapacity / LeastRecords / vehicles)
    Option.when(settings.duration > longest)(
      s"duration: expected at most ${longest.toSeconds.brief} s in virtual time, which keeps the records of " +
        s"${Decimals.counted(vehicles, "vehicle")} in memory, got ${settings.duration.toSeconds.brief} s"
    )

  /** Records that a vehicle makes in a period; loops over links have made 6 and more. */
  private val LeastRecords = 4

  /** Simulates a flight on the calling thread, to its end.
    *
    * @param limits limits of a flight whose time advances
    * @return the result with the recording, or why the flight failed
    */
  def fly(
      settings: FlySettings,
      plan: FlightPlan,
      limits: RunLimits = RunLimits()
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

  /** Limits of a flight. A paused flight without delays takes no virtual time, so its number of tasks grows
    * with its duration.
    */
  private[skein] def limitsOf(loop: AnyLoop, duration: Span, limits: RunLimits = RunLimits()): RunLimits =
    if loop != LoopKind.Paused then limits
    else
      val seconds = duration.toSeconds.ceil.toLong
      limits.copy(
        tasksPerInstant = limits.tasksPerInstant + TasksPerSecond * seconds,
        processorPerInstant = limits.processorPerInstant + ProcessorPerSecond * seconds
      )

  /** Maximum number of tasks per second. A team of 64 with ten readings and commands per second has a tenth
    * of this.
    */
  private val TasksPerSecond = 100_000L

  private val ProcessorPerSecond = 10.seconds

  /** Simulates one flight of a scenario on the calling thread.
    *
    * @param duration maximum duration; 0 for the scenario's own
    * @return Left says why it failed, or which vehicles were not read
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

  /** The result of the last flight of these settings, simulated on the calling thread. */
  def result(settings: FlySettings): Either[String, Result] =
    for
      flown    <- fly(settings, settings.plans.last.copy(seed = settings.seed))
      recorder <- flown.completed
      tracks   <- Tracks
        .of(RecordedTracks.of(recorder.recording))
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

/** A flight in virtual time with its whole recording. */
final case class VirtualFlightResult(landed: FlightResult, recorder: MemoryRecorder):
  /** The recorder of the flight, or why it failed. */
  def completed: Either[String, MemoryRecorder] = landed.outcome match
    case FlightOutcome.Failed(reason) => Left(reason)
    case _                            => Right(recorder)

/** A flight in virtual time that failed or has no usable result. */
final case class NotFlown(plan: FlightPlan, reason: String):
  def message: String = s"${plan.id}, seed ${plan.seed}: $reason"

object NotFlown:
  private val TraceLines = 30

  /** The final message to the user about failed flights. */
  def message(missing: Seq[NotFlown], planned: Int): String =
    (s"${missing.size} of $planned flights could not be flown:" +: missing.map(_.message)).mkString("\n")

  /** The reason of a failure that the user can fix: the user's own code failed, or the program was started
    * without virtual time's agent, as development environments do.
    */
  private[skein] def mendable(error: Throwable): Option[String] =
    OwnFailure.behind(error).map(_.getMessage).orElse:
      Iterator.iterate(error)(_.getCause).takeWhile(_ != null).collectFirst:
        case stopped: VirtualTimeException if stopped.problem.isInstanceOf[Problem.NoAgent] =>
          stopped.getMessage

  /** The exception with its stack and causes; for a failure that the user can fix, only its reason. */
  private[skein] def trace(error: Throwable): String = mendable(error) match
    case Some(reason) => reason
    case None         =>
      val text = StringWriter()
      error.printStackTrace(PrintWriter(text))
      text.toString.linesIterator.take(TraceLines).mkString("\n")
