package skein.solver

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{ExecutionContext, Future}
import skein.loop.*
import skein.loop.planning.CountedPlanWorkers
import skein.policy.Fleet
import skein.record.{Event, EventKind, EventSubject, MemoryRecorder, Recording, Samples}
import skein.scenario.PaperDuel
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

/** A duel in virtual time whose decisions are made by a solver behind a link that a test controls.
  *
  * @param questions requests that a solver received, by its start, vehicle and number
  */
final case class SolverTrial(
    outcome: FlightOutcome,
    recording: Recording,
    counts: Exchange.Counts,
    questions: Vector[(solver: Long, vehicle: Int, number: Long)],
    distanceM: Double
):
  def events(kind: EventKind) = recording.events.filter(_.kind == kind)

  /** The decisions that no solver made, by vehicle and number. */
  def byFallback: Set[(String, Long)] =
    events(EventKind.DeadlineMissed).flatMap(event => event.vehicle.zip(event.decision)).toSet

object SolverTrial:
  enum To:
    case Solver, Flight

  val within: Span = Span.ofMillis(100)

  /** Settings of planning that is fast, but of low quality. */
  val planning: PlanSettings = PlanSettings(horizonSteps = 10, searches = 2, slices = 2, blocksPerSlice = 1)

  /** Controls of a test over a running trial. */
  final class Hand(val system: ActorSystem, start: Long => SolverDesk, override val rehearsals: Int)
      extends MessageLink:
    import system.dispatcher

    /** Whether each message to the solver was a greeting. */
    val greetings                                         = Vector.newBuilder[Boolean]
    private var desk                                      = Option.empty[SolverDesk]
    private var received: Array[Byte] => Unit             = _ => ()
    private var news: LinkNews => Unit                    = _ => ()
    private var down                                      = Option.empty[String]
    private var sent                                      = 0
    private[SolverTrial] var fate: (To, Int) => Seq[Span] = (_, _) => Seq(Span.ofMillis(5))

    def at(seconds: Double)(act: => Unit): Unit =
      system.scheduler.scheduleOnce(Span.ofSeconds(seconds).toDuration)(act): Unit

    def start(id: Long): Unit = desk = Some(start.apply(id))

    /** Loses all later messages without any notice. */
    def kill(): Unit = desk = None

    def breakLink(why: String): Unit =
      down = Some(why)
      news(LinkNews.Down(why))

    def mendLink(): Unit =
      down = None
      news(LinkNews.Up)

    def open(received: Array[Byte] => Unit, news: LinkNews => Unit): OpenLink =
      this.received = received
      this.news = news
      after(Span.ofMillis(1).toDuration, system.scheduler)(Future.unit).foreach(_ => news(LinkNews.Up))
      new OpenLink:
        def send(message: Array[Byte]): Either[String, Unit] = down.toLeft:
          greetings += SolverMessageCodec.message(message).exists(_.isInstanceOf[SolverMessage.Hello])
          crossing(To.Solver)(desk.foreach(_.received(Seq(message), reply).fold(sys.error(_), _ => ())))
        def close(): Future[Done] = Future.successful(Done)

    private def reply(message: Array[Byte]): Unit = crossing(To.Flight)(received(message))

    private def crossing(to: To)(arrive: => Unit): Unit =
      sent += 1
      for span <- fate(to, sent) do
        after(span.toDuration, system.scheduler)(Future.unit).foreach(_ => if down.isEmpty then arrive)

  /** Runs a trial.
    *
    * @param fate arrival times of each message, by the order of sending: once, several times, or never
    * @param solverClock the solver's clock minus the controller's
    */
  def fly(
      seed: Long = 1,
      seconds: Double = 6,
      kind: LoopKind = LoopKind.Predictive,
      link: LatencyProfile = LatencyProfile.direct,
      otherwise: Fallback = Fallback.Hover,
      fleet: Fleet = PaperDuel().fleet,
      solverClock: Span = Span.ofSeconds(-7),
      takes: Question => Span = _ => Span.Zero,
      fate: (To, Int) => Seq[Span] = (_, _) => Seq(Span.ofMillis(5)),
      rehearsals: Int = 0
  )(act: Hand => Unit = _ => ()): SolverTrial =
    val run = VirtualTime.run(seed): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val theirs             = Clock.ofNanos(() => (clock.now() + solverClock).toNanos)
      val world              = FarQuadrotors(fleet, link, seed, clock)
      val flown              = Samples.heading.flight.copy(loop = kind.label, seed = seed)
      val recorder           = MemoryRecorder(Samples.heading.copy(flight = flown))
      val asked              = Vector.newBuilder[(solver: Long, vehicle: Int, number: Long)]
      def hold(solver: Long)(question: Question) =
        asked += ((solver = solver, vehicle = question.vehicle, number = question.number))
        takes(question)
      var sum, steps = 0.0
      world.watch = (at, states) =>
        if at > Span.ofSeconds(seconds - 10) && at <= Span.ofSeconds(seconds) then
          sum += states(0).positionNed.horizontalDistance(states(1).positionNed)
          steps += 1
      def deciders =
        val how   = LoopSettings(planning = planning, seed = seed)
        val plans =
          Option.when(kind == LoopKind.Plan)(JointPlanning.of(fleet, how)).flatMap(_.toOption).flatten
        val by = CountedPlanWorkers(planning.searches, planning.slices)
        FlightDeciders(fleet, plans.map(FlightDeciders.Plans(_, planning.deadline, by)))
      val hand = Hand(
        system,
        id => SolverDesk(id, "same", _ => Right(deciders), theirs, system.dispatcher, hold(id)),
        rehearsals
      )
      hand.fate = fate
      hand.start(1)
      act(hand)
      val briefing = Briefing("duel", kind.label, seed, within, within, Vector.empty, Briefing.agents(fleet))
      val client   = SolverClient(
        hand,
        flight = 1,
        "same",
        briefing,
        fleet.agents.size,
        clock,
        (kind, vehicle, detail, count) =>
          val name = vehicle.map(fleet.agents(_).name)
          recorder.offer(Event(clock.now(), kind, name, detail, None, Some(EventSubject.Solver), count))
      )
      val settings =
        LoopSettings(deadline = Some(Deadline(within, otherwise)), planning = planning, seed = seed)
      client.ready(Span.ofSeconds(5)).flatMap: _ =>
        val team = Team(fleet, world.ports, clock, recorder, settings, solver = Some(client))
        Flight
          .start(kind, team, Some(world), Span.ofSeconds(seconds), clock, recorder)
          .outcome
          .flatMap(outcome => client.close().map(_ => outcome))
          .map(outcome =>
            SolverTrial(outcome, recorder.recording, client.counts, asked.result(), sum / steps)
          )
    run.value
