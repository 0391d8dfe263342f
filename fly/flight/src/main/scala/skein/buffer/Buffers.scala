package skein.buffer

import skein.port.Moves
import skein.signal.Stamped
import skein.simulator.{PlanCall, PlannedMove}
import skein.units.*
import upack.{Bool, Msg}

/** The buffers of plans on the side of a simulator that has none: decides what happens to each client's call,
  * and which moves are sent when. Pure: the owner supplies the time, on the machine's clock, and carries out
  * the orders. A ticket identifies each call until its verdict.
  *
  * A plan is answered when it arrives, as by the built-in simulator. Before that, the vehicle is read once,
  * unless the simulator's clock is known from a recent reading. While a plan has unsent moves, the clock is
  * read every [[Buffers.ReadEvery]]. While the clock stands still, or no reading is answered, no move is
  * sent.
  *
  * Plans outlast the connections over which they arrived, as in the built-in simulator: they end with their
  * last move. They end earlier when a client moves the vehicle, cancels its task, ends its API control,
  * places it or resets the simulator.
  *
  * @param unnamed the simulator's default vehicle, for calls without a vehicle's name
  * @param known vehicles that have answered a reading
  * @param waiting plans that wait for a reading of their vehicle, indexed by vehicle
  * @param resets tickets of calls for all vehicles that wait for answers to the buffer's moves
  * @param looking vehicles with a pending reading
  * @param lookAt earliest time of the next reading
  */
private[buffer] final case class Buffers(
    vehicles: Map[String, VehicleBuffer] = Map.empty,
    unnamed: String = "",
    known: Set[String] = Set.empty,
    waiting: Map[String, Vector[(ticket: Long, plan: PlanCall)]] = Map.empty,
    resets: Vector[Long] = Vector.empty,
    clock: Option[ObservedClock] = None,
    looking: Set[String] = Set.empty,
    lookAt: Instant = Instant.Epoch,
    counts: BufferCounts = BufferCounts()
):
  import Buffers.*

  /** Adds a client's call, which is accepted or refused, now or later. */
  def received(ticket: Long, wish: Wish, now: Instant): Stepped = (wish match
    case Wish.Plan(Left(mistake)) => refused(ticket, mistake)
    case Wish.Plan(Right(plan))   => planned(ticket, plan, now)
    case Wish.Move(vehicle)       => moved(ticket, vehicle)(_.forgotten)
    case Wish.Hover(vehicle)      => moved(ticket, vehicle)(_.stopped(shows(now)))
    case Wish.Stop(vehicle)       => changed(vehicle)(_.stopped(shows(now))).passing(ticket, None)
    case Wish.Place(vehicle)      => changed(vehicle)(_.forgotten).passing(ticket, None)
    case Wish.Reset               =>
      Stepped(copy(
        vehicles = vehicles.view.mapValues(_.forgotten).filterNot(_._2.isIdle).toMap,
        resets = resets :+ ticket,
        counts = if vehicles.values.forall(_.ours < Moves.InFlight) then counts else heldOne
      ))
  ).settled(now)

  /** Adds a reading of a vehicle; `Left` states why it was not answered.
    *
    * @param unnamed the simulator's default vehicle
    */
  def looked(vehicle: String, answer: Either[String, Stamped[?]], unnamed: String, now: Instant): Stepped =
    val plans = waiting.getOrElse(vehicle, Vector.empty)
    val seen  = copy(unnamed = unnamed, waiting = waiting - vehicle, looking = looking - vehicle)
    (answer match
      case Left(reason) =>
        val text = PlanCall.refusal(reason)
        plans.foldLeft(Stepped(seen.copy(lookAt = now + FailedPause))):
          case (before, (ticket, _)) => before.and(_.refused(ticket, text))
      case Right(reading) =>
        val next = seen.copy(
          known = known + vehicle,
          clock = Some(clock.fold(ObservedClock.of(reading))(_.updated(reading))),
          lookAt = now + ReadEvery
        )
        plans.foldLeft(Stepped(next)):
          case (before, (ticket, plan)) => before.and(_.planned(ticket, plan, now))
    ).settled(now)

  /** Adds the simulator's answer to a move of the buffer.
    *
    * @param isDone whether the move was carried out, wholly or until another replaced it
    */
  def ended(vehicle: String, isDone: Boolean, now: Instant): Stepped =
    val failed = if isDone then counts else counts.copy(failedMoves = counts.failedMoves + 1)
    Stepped(copy(counts = failed).updated(vehicle)(_.ended(now))).settled(now)

  /** Adds the simulator's answer to a client's move; also called if that answer will not be noticed. */
  def answered(vehicle: String, now: Instant): Stepped =
    Stepped(updated(vehicle)(_.endedTheirs(now))).settled(now)

  /** Carries out what is due now; to be called at [[wakeAt]]. */
  def due(now: Instant): Stepped = Stepped(this).settled(now)

  /** Time at which [[due]] has something to do, unless another event occurs earlier. */
  def wakeAt(now: Instant): Option[Instant] =
    val moves = vehicles.values.flatMap(_.wakeAt(clock, maySend = resets.isEmpty, now))
    (moves ++ Option.when(mayLook)(lookAt)).minOption

  def lost(): Buffers = copy(counts = counts.copy(lostConnections = counts.lostConnections + 1))

  private def shows(now: Instant) = clock.flatMap(_.shows(now))

  private def named(vehicle: String) = if vehicle.isEmpty then unnamed else vehicle

  private def heldOne = counts.copy(heldCalls = counts.heldCalls + 1)

  private def changed(vehicle: String)(change: VehicleBuffer => VehicleBuffer): Buffers =
    updated(named(vehicle))(change)

  private def updated(name: String)(change: VehicleBuffer => VehicleBuffer): Buffers =
    vehicles.get(name).map(change).fold(this)(next =>
      copy(vehicles = if next.isIdle then vehicles - name else vehicles.updated(name, next))
    )

  private def passing(ticket: Long, vehicle: Option[String]): Stepped =
    Stepped(this, Vector(Order.Judge(ticket, Verdict.Pass(vehicle))))

  private def refused(ticket: Long, text: String): Stepped =
    Stepped(
      copy(counts = counts.copy(refusedPlans = counts.refusedPlans + 1)),
      Vector(Order.Judge(ticket, Verdict.Answer(Left(text))))
    )

  private def planned(ticket: Long, plan: PlanCall, now: Instant): Stepped =
    val name = named(plan.vehicle)
    shows(now) match
      case Some(simulated) if known(name) => taken(ticket, plan, name, simulated)
      case _ if !known(name) && known.size + waiting.size >= MostVehicles =>
        refused(ticket, PlanCall.refusal(s"expected plans of at most $MostVehicles vehicles, got one more"))
      case _ =>
        val others = waiting.getOrElse(name, Vector.empty)
        val next   = copy(waiting = waiting.updated(name, others.appended((ticket = ticket, plan = plan))))
        if looking(name) then Stepped(next)
        else Stepped(next.copy(looking = looking + name), Vector(Order.Look(name)))

  private def taken(ticket: Long, plan: PlanCall, name: String, simulated: Instant): Stepped =
    val before = vehicles.getOrElse(name, VehicleBuffer())
    val accept = Vector(Order.Judge(ticket, Verdict.Answer(Right(Bool(true)))))
    if plan.moves.isEmpty then Stepped(this, accept)
    else if !before.plans.isNews(plan.sequence) then
      Stepped(copy(counts = counts.copy(stalePlans = counts.stalePlans + 1)), accept)
    else
      Stepped(
        copy(
          vehicles = vehicles.updated(name, before.received(plan.sequence, plan.moves, simulated)),
          counts = counts.copy(plans = counts.plans + 1)
        ),
        accept
      )

  private def moved(ticket: Long, vehicle: String)(change: VehicleBuffer => VehicleBuffer): Stepped =
    val name   = named(vehicle)
    val before = change(vehicles.getOrElse(name, VehicleBuffer()))
    val next   = before.copy(held = before.held :+ ticket)
    Stepped(copy(
      vehicles = vehicles.updated(name, next),
      counts = if before.ours + before.theirs < Moves.InFlight || before.ours == 0 then counts else heldOne
    ))

  /** Passes on the calls that may pass, sends the moves that are due, and reads the clock if needed. */
  private def settled(now: Instant): Stepped =
    vehicles.keys.toVector.sorted
      .foldLeft(letAll())((before, name) => before.and(_.turn(name, now)))
      .and(_.look(now))

  /** Passes the calls for all vehicles, once no vehicle has two unanswered moves of the buffer. */
  private def letAll(): Stepped =
    if resets.isEmpty || vehicles.values.exists(_.ours >= Moves.InFlight) then Stepped(this)
    else Stepped(copy(resets = Vector.empty), resets.map(Order.Judge(_, Verdict.Pass(None))))

  private def turn(name: String, now: Instant): Stepped =
    val vehicle = vehicles(name)
    if vehicle.held.nonEmpty then
      if !vehicle.lets(now) then Stepped(this)
      else
        val next = vehicle.copy(theirs = vehicle.theirs + 1, held = vehicle.held.drop(1))
        copy(vehicles = vehicles.updated(name, next))
          .passing(vehicle.held.head, Some(name))
          .and(_.turn(name, now))
    else if resets.nonEmpty then Stepped(this)
    else
      val sent =
        for
          simulated <- shows(now)
          due       <- vehicle.next(simulated, now)
        yield
          val late = simulated.since(due.move.at)
          val move = due.move.begun(late).getOrElse(PlannedMove.hover(due.move.at))
          val own  = simulated.since(due.move.at.max(due.since))
          Stepped(
            copy(
              vehicles = vehicles.updated(name, vehicle.sent(due, now)),
              counts = counts.copy(moves = counts.moves + 1, latest = counts.latest.max(own))
            ),
            Vector(Order.Move(name, move))
          )
      sent.getOrElse(Stepped(this))

  /** Whether the clock must be read and no reading is pending. */
  private def mayLook = looking.isEmpty && vehicles.values.exists(_.isFollowing)

  private def look(now: Instant): Stepped =
    val following = Option.when(mayLook && now >= lookAt)(vehicles.filter(_._2.isFollowing).keys.min)
    following.fold(Stepped(this)): name =>
      Stepped(copy(looking = looking + name), Vector(Order.Look(name)))

private[buffer] object Buffers:
  /** Pause from a reading's answer to the next reading: more than [[skein.signal.ClockAlignment.Tick]]. */
  val ReadEvery: Span = Span.ofMillis(10)

  /** Pause after a reading that was not answered, or refused. */
  val FailedPause: Span = Span.ofMillis(100)

  /** Maximum number of vehicles with plans; plans for further vehicles are refused. */
  val MostVehicles = 256

  enum Verdict:
    /** The call goes to the simulator.
      *
      * @param vehicle the vehicle that the call moves, if any: [[Buffers.answered]] must be called when the
      *   move is answered
      */
    case Pass(vehicle: Option[String])

    /** The call is answered by the buffer and goes no further; `Left` is the text of its error. */
    case Answer(answer: Either[String, Msg])

  enum Order:
    case Judge(ticket: Long, verdict: Verdict)

    case Look(vehicle: String)

    /** Sends a move to the vehicle; [[Buffers.ended]] must be called at its end. */
    case Move(vehicle: String, move: PlannedMove)

  /** The buffers after an event, with the orders that follow from it. */
  final case class Stepped(buffers: Buffers, orders: Vector[Order] = Vector.empty):
    def and(step: Buffers => Stepped): Stepped =
      val next = step(buffers)
      Stepped(next.buffers, orders ++ next.orders)

    def settled(now: Instant): Stepped = and(_.settled(now))
