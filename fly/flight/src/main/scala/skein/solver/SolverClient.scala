package skein.solver

import org.apache.pekko.Done
import org.apache.pekko.actor.{ActorSystem, Cancellable}
import scala.concurrent.{Future, Promise}
import skein.loop.{Memory, Solved, Solver, TeamView}
import skein.record.EventKind
import skein.solver.Exchange.{Counts, Verdict}
import skein.units.*

/** A flight's side: sends requests to a solver over a link, and says hello again whenever the link is lost or
  * the solver restarts.
  *
  * @param flight unique identifier of the flight
  * @param vehicles number of vehicles
  * @param note called with records of late, repeated, skipped or lost messages, with the vehicle if it
  *   concerns one, and with their count if it is not one
  */
final class SolverClient(
    link: MessageLink,
    flight: Long,
    build: String,
    briefing: Briefing,
    vehicles: Int,
    clock: Clock,
    note: (EventKind, Option[Int], String, Option[Long]) => Unit
)(using system: ActorSystem) extends Solver:
  import SolverClient.*
  import system.dispatcher

  private val hello   = SolverMessageCodec.bytes(SolverMessage.Hello(flight, build, briefing))
  private val lock    = Object()
  private val started = Promise[Done]()

  // All below is guarded by the lock.
  private var exchange       = Exchange.of(vehicles)
  private var waiting        = Map.empty[Int, Waiting]
  private var standing       = Standing.Greeting(Silent)
  private var rehearsals     = link.rehearsals
  private var rehearsedUntil = Option.empty[Instant]
  private var preparedAt     = Option.empty[Instant]
  private var late           = Option.empty[Cancellable]

  // Other threads that report news meanwhile wait for this value.
  private lazy val open = link.open(received, told)
  open: Unit

  private val timer =
    system.scheduler.scheduleWithFixedDelay(GreetEvery.toDuration, GreetEvery.toDuration)(() => greet())

  /** Completes when a solver has accepted the flight, with its answer; fails with [[SolverClient.NoSolver]]
    * if one refuses, or none answers within the patience. A solver that reports that it prepares has
    * [[SolverClient.MostPrepared]] at most.
    */
  def ready(patience: Span): Future[Done] =
    val begun                        = clock.now()
    def expect(until: Instant): Unit =
      val timer = system.scheduler.scheduleOnce(until.since(clock.now()).toDuration):
        val prepared = lock.synchronized(preparedAt)
        prepared.map(at => (at + patience).min(begun + MostPrepared)).filter(_ > until) match
          case Some(later) => expect(later)
          case None        =>
            val within = until.since(begun).toSeconds.round
            started.tryFailure(NoSolver(s"no solver within $within s: $whyNone")): Unit
      lock.synchronized:
        late = Some(timer)
    expect(begun + patience)
    started.future.andThen(_ => lock.synchronized(late).foreach(_.cancel()))

  /** Why no solver has accepted the flight so far. */
  def whyNone: String = lock.synchronized(standing).why

  def delay: Span = lock.synchronized(exchange.delay)

  def counts: Counts = lock.synchronized(exchange.counts)

  /** The latest round trips, of used answers. */
  def roundTrips: Vector[Span] = lock.synchronized(exchange.trips)

  def ask(
      deciders: Vector[(vehicle: Int, memory: Memory)],
      remembered: Option[Solver.Remembered],
      view: TeamView,
      askedAt: Instant,
      until: Instant,
      searching: Span
  ): Future[Solved] = lock.synchronized:
    standing match
      case Standing.Greeting(_) | Standing.Refused(_) => Future.failed(NoSolver(standing.why))
      case Standing.Welcome                           =>
        val vehicle        = deciders.head.vehicle
        val (next, number) = exchange.asked(vehicle, askedAt, until, searching)
        val used           = remembered.map(last => (solver = last.solver, question = last.question))
        val question       = Question(flight, deciders, number, askedAt, next.solverClock, used, view)
        open.send(SolverMessageCodec.bytes(SolverMessage.Ask(question))) match
          case Left(why) => Future.failed(NoSolver(why))
          case Right(()) =>
            val answer = Promise[Solved]()
            val known = exchange.clocks.map(known => (offset = known.offset, uncertainty = known.uncertainty))
            exchange = next
            waiting = waiting.updated(vehicle, Waiting(deciders.size, known, answer))
            answer.future

  def close(): Future[Done] =
    timer.cancel()
    val _ = open.send(SolverMessageCodec.bytes(SolverMessage.Goodbye(flight)))
    open.close()

  private def received(bytes: Array[Byte]): Unit = SolverMessageCodec.message(bytes) match
    case Left(mistake)  => noted(EventKind.Refused, s"from the solver came no message: $mistake")
    case Right(message) =>
      message match
        case SolverMessage.Preparing(`flight`)                     => prepares()
        case SolverMessage.Welcome(`flight`, _)                    => welcomed()
        case SolverMessage.Refused(`flight`, reason)               => refused(s"the solver refuses: $reason")
        case SolverMessage.Unknown(`flight`)                       => again("it does not know this flight")
        case SolverMessage.Tell(answer) if answer.flight == flight => heard(answer)
        // A message for another flight on a shared link.
        case _ => ()

  private def heard(answer: Answer): Unit =
    val now                   = clock.now()
    val (verdict, more, asks) = lock.synchronized:
      val (heard, verdict) = exchange.heard(answer, now)
      val (next, more)     = heard.news(answer)
      exchange = next
      val asks = waiting.get(answer.vehicle).filter(_ => verdict.isInstanceOf[Verdict.Counts])
      if asks.isDefined then waiting = waiting.removed(answer.vehicle)
      (verdict, more, asks)
    def said(kind: EventKind, text: String) = note(kind, Some(answer.vehicle), text, None)
    verdict match
      case Verdict.Counts(askedAt) => asks.foreach(waits => answered(waits, answer, askedAt, now))
      case Verdict.Late(after)     =>
        said(
          EventKind.LateReply,
          s"answer ${answer.number} of the solver came after ${after.toMillis.round} ms; it was not used"
        )
      case Verdict.Repeated =>
        said(EventKind.Repeated, s"answer ${answer.number} of the solver came once more")
      case Verdict.Foreign =>
        noted(EventKind.Refused, s"the solver answered question ${answer.number}, which nobody asked")
    if more.overtaken > 0 then
      noted(
        EventKind.Dropped,
        s"${more.overtaken} questions were left at the solver for newer ones",
        Some(more.overtaken)
      )
    if more.repeated > 0 then
      noted(
        EventKind.Repeated,
        s"${more.repeated} questions came to the solver more than once",
        Some(more.repeated)
      )

  private def noted(kind: EventKind, text: String, count: Option[Long] = None): Unit =
    note(kind, None, text, count)

  private def answered(waits: Waiting, answer: Answer, askedAt: Instant, now: Instant): Unit =
    val _ = answer.result match
      case Left(reason)                                          => waits.answer.tryFailure(NoSolver(reason))
      case Right(choice) if choice.chosen.size != waits.vehicles =>
        waits.answer.tryFailure(NoSolver(
          s"the solver was asked for ${waits.vehicles} vehicles and decided for ${choice.chosen.size}"
        ))
      case Right(choice) =>
        waits.answer.trySuccess(
          Solved(
            answer.solver,
            answer.number,
            askedAt,
            choice.decidedAt,
            now,
            answer.answeredAt.since(answer.takenAt),
            waits.clock,
            choice.begunAnew,
            choice.chosen
          )
        )

  private def told(news: LinkNews): Unit = news match
    case LinkNews.Up              => again(Silent)
    case LinkNews.Refused(reason) => refused(reason)
    case LinkNews.Down(reason)    =>
      val lost = lock.synchronized:
        val lost = waiting.values.toVector
        val was  = standing
        waiting = Map.empty
        standing = Standing.Greeting(reason)
        Option.when(was == Standing.Welcome)(lost)
      lost.foreach: lost =>
        noted(EventKind.Disconnected, s"the solver is lost: $reason")
        lost.foreach(_.answer.tryFailure(NoSolver(reason)))

  private def again(why: String): Unit =
    lock.synchronized:
      standing = Standing.Greeting(why)
    greet()

  private def greet(): Unit =
    if lock.synchronized(greets) then
      for why <- open.send(hello).left do
        lock.synchronized:
          if greets then standing = Standing.Greeting(why)

  private def greets: Boolean = standing.isInstanceOf[Standing.Greeting]

  private def prepares(): Unit = lock.synchronized:
    preparedAt = Some(clock.now())
    if greets then standing = Standing.Greeting(StillPreparing)

  private def welcomed(): Unit =
    if rehearses() then greet()
    else
      val isNew = lock.synchronized:
        val was = standing
        standing = Standing.Welcome
        was != Standing.Welcome
      if isNew && !started.trySuccess(Done) then noted(EventKind.Reconnected, "a solver is there again")

  /** Whether it greets once more, before the first request. */
  private def rehearses(): Boolean = lock.synchronized:
    val until = rehearsedUntil.getOrElse(clock.now() + RehearsedFor)
    val again = rehearsals > 0 && clock.now() < until
    rehearsedUntil = Some(until)
    rehearsals = if again then rehearsals - 1 else 0
    if again then standing = Standing.Greeting("it answered, and then fell silent")
    again

  private def refused(why: String): Unit =
    lock.synchronized:
      standing = Standing.Refused(why)
    if !started.tryFailure(NoSolver(why)) then noted(EventKind.Refused, why)

object SolverClient:
  private val GreetEvery = Span.ofMillis(500)

  /** Longest duration of the rehearsal; a slow link's code need not be fast. */
  private val RehearsedFor = Span.ofSeconds(3)

  /** Longest wait for a solver that prepares. */
  val MostPrepared: Span = Span.ofSeconds(600)

  private val Silent         = "nobody has answered; is ./skein decide started?"
  private val StillPreparing = "the solver prepares for the flight, and has not finished"

  /** No solver decides for the flight; the message states why. */
  final case class NoSolver(reason: String) extends RuntimeException(reason, null, false, false):
    override def toString: String = reason

  private final case class Waiting(
      vehicles: Int,
      clock: Option[(offset: Span, uncertainty: Span)],
      answer: Promise[Solved]
  )

  private enum Standing(val why: String):
    case Greeting(reason: String) extends Standing(reason)
    case Welcome                  extends Standing("it is there")
    case Refused(reason: String)  extends Standing(reason)
