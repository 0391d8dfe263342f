package skein.solver

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{ExecutionContext, Future}
import skein.units.*

/** A solver: decides for every flight that it accepts, over any link.
  *
  * @param id unique identifier of this start
  * @param build this program's build; a flight's must be equal
  * @param decidersOf makes the deciders for a flight's briefing, or states why it cannot; if it is slow, the
  *   flight is informed
  * @param clock the solver's clock, independent of the controllers'
  * @param workers the threads that execute decisions
  * @param takes artificial delay of each answer, for trials
  */
final class SolverDesk(
    id: Long,
    build: String,
    decidersOf: Briefing => Either[String, FlightDeciders],
    clock: Clock,
    workers: ExecutionContext,
    takes: Question => Span = _ => Span.Zero,
    told: String => Unit = _ => ()
)(using system: ActorSystem):
  import SolverDesk.*

  private val lock     = Object()
  private var sessions = Map.empty[Long, Session]
  private var greeting = Set.empty[Long]
  private var uses     = 0L
  private var answered = 0L
  private var refused  = 0L
  private var garbled  = 0L

  def stats: Stats = lock.synchronized(Stats(sessions.size, answered, refused, garbled))

  /** Processes messages in this order; decisions begin after all are read.
    *
    * @param reply sends to their sender; must not block
    * @return whether any of them was useful: a hello or request of a flight that is, or will be, accepted;
    *   Left describes what was not a message
    */
  def received(messages: Seq[Array[Byte]], reply: Array[Byte] => Unit): Either[String, Boolean] =
    val (mistakes, known) = messages.map(SolverMessageCodec.message).partitionMap(identity)
    var isOfUse           = false
    val asked             = known.flatMap:
      case SolverMessage.Hello(flight, theirs, briefing) =>
        isOfUse |= greeted(flight, theirs, briefing, reply)
        None
      case SolverMessage.Ask(question)   => offered(question, reply)
      case SolverMessage.Goodbye(flight) =>
        if leaving(_.removed(flight)) > 0 then told(s"flight ${flight.toHexString} has ended")
        None
      case _ => None
    for (flight, vehicle) <- asked.distinct do next(flight, vehicle)
    mistakes.headOption match
      case None          => Right(isOfUse || asked.nonEmpty)
      case Some(mistake) =>
        lock.synchronized:
          garbled += mistakes.size
        Left(mistake)

  /** Handles a hello. Returns whether the flight has been accepted or is being prepared; preparation may
    * still end in a refusal.
    */
  private def greeted(flight: Long, theirs: String, briefing: Briefing, reply: Array[Byte] => Unit): Boolean =
    val known = lock.synchronized(sessions.get(flight).exists(_.briefing == briefing))
    def answer(message: SolverMessage) = reply(SolverMessageCodec.bytes(message))
    def no(reason: String)             =
      lock.synchronized:
        refused += 1
      told(s"refused a flight: $reason")
      answer(SolverMessage.Refused(flight, reason.take(MostReason)))
    if known then
      lock.synchronized:
        sessions = sessions.updatedWith(flight)(_.map(_.copy(reply = reply)))
      answer(SolverMessage.Welcome(flight, id))
      true
    else if theirs != build then
      no(
        s"this solver is build $build, the flight's program is " +
          s"build $theirs; start both from the same program"
      )
      false
    else if begins(flight) then
      Future(decidersOf(briefing))(using workers).onComplete { result =>
        lock.synchronized:
          greeting -= flight
        val made = result.fold(error => Left(s"it cannot be decided for: $error"), identity)
        made.flatMap(deciders => differing(briefing, deciders).toLeft(deciders)) match
          case Left(reason) =>
            made.foreach(_.close())
            no(reason)
          case Right(deciders) =>
            val vehicles = deciders.fleet.agents.size
            admitted(flight, Session(briefing, deciders, Desk.of(vehicles), reply, 0))
            told(s"flight ${flight.toHexString}: ${briefing.scenario}, ${briefing.loop}, $vehicles vehicles")
            answer(SolverMessage.Welcome(flight, id))
      }(using workers)
      true
    else
      // The flight repeats its hello until then.
      val isPreparing = lock.synchronized(greeting(flight))
      if isPreparing then answer(SolverMessage.Preparing(flight))
      isPreparing

  /** Whether preparation for a flight must begin. A flight repeats its hello until it is answered; one
    * preparation is enough.
    */
  private def begins(flight: Long): Boolean = lock.synchronized:
    val isNew = !greeting(flight) && greeting.size < MostFlights
    if isNew then greeting += flight
    isNew

  private def differing(briefing: Briefing, deciders: FlightDeciders): Option[String] =
    briefing.agents.zipAll(Briefing.agents(deciders.fleet), "nobody", "nobody").collectFirst:
      case (there, here) if there != here =>
        s"the scenario is another here: the flight has $there, this solver $here"

  private def admitted(flight: Long, session: Session): Unit =
    // Flights that ended without a goodbye are removed in the end.
    val _ = leaving: sessions =>
      uses += 1
      val others = sessions.removed(flight)
      val kept   = if others.size < MostFlights then others else others.removed(others.minBy(_._2.usedAt)._1)
      kept.updated(flight, session.copy(usedAt = uses))

  /** Ends all flights' sessions and the planners of their decisions. */
  def close(): Unit = leaving(_ => Map.empty): Unit

  /** Changes the sessions, and closes those that are replaced or left out; returns their number. */
  private def leaving(change: Map[Long, Session] => Map[Long, Session]): Int =
    val left = lock.synchronized:
      val before = sessions
      sessions = change(before)
      before.filterNot((flight, session) =>
        sessions.get(flight).exists(_.deciders eq session.deciders)
      ).values
    left.foreach(_.deciders.close())
    left.size

  /** Adds a request. Returns the vehicle with a decision that may begin now, if any. */
  private def offered(question: Question, reply: Array[Byte] => Unit): Option[(Long, Int)] =
    lock.synchronized:
      sessions.get(question.flight) match
        case None =>
          reply(SolverMessageCodec.bytes(SolverMessage.Unknown(question.flight)))
          None
        case Some(session) if !isOf(session.deciders, question) =>
          garbled += 1
          None
        case Some(session) =>
          uses += 1
          sessions = sessions.updated(
            question.flight,
            session.copy(desk = session.desk.offered(question, clock.now()), reply = reply, usedAt = uses)
          )
          Some((question.flight, question.vehicle))

  /** Whether the request is for vehicles with joint decisions, and its view has all vehicles. */
  private def isOf(deciders: FlightDeciders, question: Question): Boolean =
    question.view.readings.size == deciders.fleet.agents.size &&
      deciders.together(question.vehicle) == question.deciders.map(_.vehicle)

  private def next(flight: Long, vehicle: Int): Unit =
    val work = lock.synchronized:
      sessions.get(flight).flatMap: session =>
        val (desk, waiting) = session.desk.taken(vehicle)
        sessions = sessions.updated(flight, session.copy(desk = desk))
        waiting.map((session, _))
    for (session, waiting) <- work do
      Future(decided(session, waiting.question))(using workers).flatten
        .recover { case error => Left(Option(error.getMessage).getOrElse(error.toString)) }(using workers)
        .flatMap(made => held(waiting.question, made))(using workers)
        .foreach(made => done(waiting, made))(using workers)

  private def held[A](question: Question, made: A): Future[A] =
    val span = takes(question)
    if span == Span.Zero then Future.successful(made)
    else after(span.toDuration, system.scheduler)(Future.successful(made))(using workers)

  private def decided(session: Session, question: Question): Future[Either[String, (Choice, Any)]] =
    val memory = session.desk.memory(question, id)
    val begins = memory.isEmpty && question.remembered.isDefined
    // By the controller's clock, as far as it is known.
    val now = question.solverClock
      .filter(_.solver == id)
      .fold(question.askedAt)(known => question.askedAt.max(clock.now() + known.offset))
    if !question.view.isComplete then Future.successful(Left("not every vehicle was seen"))
    else
      session.deciders
        .decide(question, memory, now)
        .map((chosen, held) => Right((Choice(now, begins, chosen), held)))(using ExecutionContext.parasitic)

  private def done(waiting: Desk.Waiting, made: Either[String, (Choice, Any)]): Unit =
    import waiting.question
    val answer = lock.synchronized:
      answered += 1
      sessions.get(question.flight).map: session =>
        val desk = session.desk.done(question, made.toOption.map(_._2))
        sessions = sessions.updated(question.flight, session.copy(desk = desk))
        val told = Answer(
          question.flight,
          question.vehicle,
          question.number,
          id,
          waiting.takenAt,
          clock.now(),
          desk.overtaken,
          desk.repeated,
          made.map(_._1).left.map(_.take(MostReason))
        )
        (session.reply, told)
    for (reply, answer) <- answer do
      val told =
        try SolverMessageCodec.bytes(SolverMessage.Tell(answer))
        catch // Plans of very many vehicles may exceed a message.
          case tooLong: IllegalArgumentException =>
            SolverMessageCodec.bytes(SolverMessage.Tell(answer.copy(result = Left(tooLong.getMessage))))
      reply(told)
    next(question.flight, question.vehicle)

object SolverDesk:
  /** Maximum number of simultaneous flights; beyond it, the one silent for the longest time is removed. */
  val MostFlights = 64

  private val MostReason = 4096

  /** The solver's counts.
    *
    * @param flights number of accepted flights
    * @param garbled number of received pieces that were neither a message nor a request of their flight
    */
  final case class Stats(flights: Int, answered: Long, refused: Long, garbled: Long)

  private final case class Session(
      briefing: Briefing,
      deciders: FlightDeciders,
      desk: Desk,
      reply: Array[Byte] => Unit,
      usedAt: Long
  )
