package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.annotation.tailrec
import scala.concurrent.Future
import skein.link.{BackgroundThread, ControlThreads, Transport}
import skein.record.MemoryRecorder
import skein.settings.{FlySettings, OutsidePolicy, SolverChoice, Wire}
import skein.signal.LatencyProfile
import skein.units.*

/** Simulates the flights in advance, so that the code of a decision is compiled before the first one counts:
  * in virtual time, over equal links, and then over real sockets. At ten decisions per second a flight of a
  * minute would end before it is compiled: cold, a decision takes many times as long from the reading to the
  * command (`skein.bench.FrameworkLatency`).
  */
object WarmUp:
  /** Number of virtual flights for a warm-up. */
  val Flights = 20

  /** Maximum real time of the warm-up, which large teams and loops that plan would exceed. */
  val AtMost: Span = Span.ofSeconds(3)

  /** Duration of each virtual flight: short, so that every loop and link has its turn. */
  val Flown: Span = Span.ofSeconds(5)

  /** Duration, period and vehicles of the rehearsal, in real time: as many decisions as a duel makes in two
    * minutes.
    */
  private val Rehearsed         = Span.ofSeconds(3)
  private val RehearsalPeriod   = Span.ofMillis(20)
  private val RehearsalVehicles = 20

  /** Simulates the plans of `settings` in turn in virtual time; blocks.
    *
    * @param flights number after which it ends, or with the first flight that ends later than [[AtMost]]
    * @return number of flights, or why one failed
    */
  def fly(settings: FlySettings, flights: Int, clock: Clock): Either[String, Int] =
    // For another process virtual time stands still: a slow one would take minutes.
    val policies = settings.policies.filterNot(OutsidePolicy.decides)
    val short    = settings.copy(
      duration = settings.duration.min(Flown),
      policies = policies,
      only = None,
      onlyPolicies = settings.onlyPolicies && policies.nonEmpty,
      solver = settings.solver.map(_ => SolverChoice.Link(LatencyProfile.direct))
    )
    val plans = short.plans
    val until = clock.now() + AtMost

    @tailrec
    def next(flown: Int): Either[String, Int] =
      if flown == flights || clock.now() >= until then Right(flown)
      else
        val plan = plans(flown % plans.size)
        VirtualFlights.fly(short, plan).flatMap(_.completed) match
          case Left(reason) => Left(s"${plan.id}, to warm up: $reason")
          case Right(_)     => next(flown + 1)

    next(0)

  /** Flies every loop of `settings` side by side, in real time if `transport` and `clock` are real, without a
    * link, against built-in simulators, with more vehicles and a shorter period: this warms up the sockets
    * and threads that virtual time replaces. Afterwards the JIT compiler's priority is below that of the
    * flight, and [[skein.link.ControlThreads]] have the highest.
    *
    * @return number of decisions, or why a loop could not start
    */
  def rehearse(settings: FlySettings, transport: Transport, clock: Clock)(using
      system: ActorSystem
  ): Future[Either[String, Int]] =
    import system.dispatcher
    val alone = settings.copy(
      // Vehicles by MAVLink climb to their starts first, which would take a minute.
      wire = Wire.AirSim,
      solver = None,
      decentralised = false,
      between = None,
      only = None,
      links = List(LatencyProfile.none),
      duration = settings.duration.min(Rehearsed),
      period = settings.period.min(RehearsalPeriod)
    )
    val plans     = alone.plans
    val assembler = FlightAssembler(
      transport,
      clock,
      alone.copy(scenario = alone.scenario.crowded(RehearsalVehicles / plans.size)),
      simulator = None
    )
    Future
      .traverse(plans): plan =>
        val recorder = MemoryRecorder(assembler.heading(plan, "real"))
        assembler
          .start(plan, recorder)
          .flatMap:
            case Left(reason) => Future.successful(Left(s"${plan.id}, to warm up: $reason"))
            // However it ends: a busy machine may fall silent here, before anything counts.
            case Right(assembly) => assembly.landed.map(_ => Right(recorder.recording.decisions.size))
      .map: flown =>
        BackgroundThread.compilersGiveWay(): Unit
        ControlThreads.lead(): Unit
        flown.collectFirst { case Left(reason) => reason }.toLeft(flown.flatMap(_.toOption).sum)
