package skein.offboard

import skein.mavlink.*
import skein.mavlink.CommonDialect.{Command, ModeFlag, NoAutopilot, Result, Severity}
import skein.policy.Action
import skein.port.VehicleError
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.units.Decimals.fixed

/** Settings of vehicles controlled over MAVLink.
  *
  * @param renewEvery interval at which a setpoint is repeated until its action's duration has elapsed; then
  *   setpoints to stay in place are sent as often, for as long as the link is open. PX4 leaves offboard below
  *   2 Hz
  * @param sampleEvery interval of motion samples that the vehicle is requested to send
  * @param timeout time-out of every answer
  * @param farthestM the geofence: maximum horizontal distance from the flight's origin, m; a vehicle that
  *   leaves it holds its position and accepts no further actions
  * @param highestM maximum height above the flight's origin, m
  * @param exchanges number of TIMESYNC exchanges after which a vehicle is ready; until then, one is sent
  *   every [[Control.Tick]]
  */
final case class OffboardSettings(
    renewEvery: Span = Span.ofMillis(100),
    sampleEvery: Span = Span.ofMillis(50),
    timeout: Span = Span.ofSeconds(1),
    farthestM: Double = 1000,
    highestM: Double = 120,
    exchanges: Int = 1
)

/** One vehicle's control as a value: requests, received messages and passing time go in; messages and answers
  * come out. Knows no socket and no clock.
  *
  * A TIMESYNC follows every setpoint. Its answer confirms the setpoint's receipt and states its time on the
  * vehicle's clock: so an action counts as replaced when the vehicle has its successor.
  *
  * @param originNed origin of the vehicle's own frame, in the flight's
  * @param asked actions without an answer, the oldest first
  * @param readers tokens of requests for the next sample
  * @param firmware the autopilot's firmware, by its heartbeat; determines the modes
  * @param lastSync the newest TIMESYNC's time; each has a later one
  */
final case class Control(
    system: Int,
    settings: OffboardSettings = OffboardSettings(),
    originNed: Vector3 = Vector3.Zero,
    origin: Option[GeoLocation] = None,
    estimate: ReportedMotion = ReportedMotion(),
    clock: Option[VehicleClock] = None,
    shift: (shift: Span, doubt: Span) = (shift = Span.Zero, doubt = Span.Zero),
    asked: Vector[Control.Asked] = Vector.empty,
    flown: Option[Action] = None,
    until: Instant = Instant.Epoch,
    renewAt: Instant = Instant.Epoch,
    readers: Vector[(token: Long, until: Instant)] = Vector.empty,
    orders: Vector[Control.Order] = Vector.empty,
    lastSync: Instant = Instant.Epoch,
    heardAt: Option[Instant] = None,
    firmware: Either[String, Firmware] = Left("no heartbeat has come"),
    mode: Long = 0,
    isArmed: Boolean = false,
    isOnGround: Boolean = true,
    isOut: Boolean = false
):
  import Control.*

  /** Whether the vehicle is ready to fly: it has sent messages, and its clock and the origin of its frame are
    * known.
    */
  def isReady: Boolean = missing.isEmpty

  /** The information still missing before the vehicle is ready to fly. */
  def missing: Vector[String] =
    if heardAt.isEmpty then Vector("any message")
    else
      Vector(
        Option.when(origin.isEmpty)("GPS_GLOBAL_ORIGIN"),
        Option.when(!isAligned)(s"answers to TIMESYNC ($exchanged of ${settings.exchanges} came)"),
        Option.when(estimate.newest.isEmpty)("ODOMETRY, or LOCAL_POSITION_NED and ATTITUDE_QUATERNION")
      ).flatten

  /** The reason why the vehicle follows no setpoints: it is disarmed, or someone else switched its mode. None
    * if it follows them.
    */
  def taken: Option[String] = firmware.toOption.flatMap: own =>
    if !isArmed then Some(s"$name is disarmed")
    else
      Option.unless(own.flyable(mode)):
        s"$name is in ${own.modeName(mode)}: somebody else has taken it over"

  private def exchanged = clock.fold(0)(_.exchanges)

  private def isAligned = exchanged >= settings.exchanges

  /** Requests the next sample.
    *
    * @return a step after which the next sample is the answer to `token`
    */
  def read(token: Long, now: Instant): Step =
    if readers.size >= MostReaders then
      answered(token, Left(VehicleError.Overloaded(s"$name: $MostReaders readings wait already")))
    else Step(copy(readers = readers :+ ((token, now + settings.timeout))))

  def act(token: Long, action: Action, lasts: Span, now: Instant): Step = known(token): own =>
    if isOut then refused(token, s"$name is outside of the geofence: it holds its position")
    else
      (taken, action) match
        case (Some(why), _)    => refused(token, why)
        case (_, Action.Hover) => hover(token, now)
        case (_, Action.Land)  =>
          givenUp(order(token, Command.Land, now, Vector.fill(7)(Float.NaN)))
        case (None, _) =>
          val next = copy(
            asked = asked :+ Asked(token, lastSync.max(now), now + lasts, replacedAt = None),
            flown = Some(action),
            until = now + lasts
          ).replacing(now)
          val entering =
            if mode == own.offboard || orders.exists(isOffboard) then Step(next)
            else next.enter(Silent, own, own.offboard, now)
          entering.andThen(_.send(now))

  def hover(token: Long, now: Instant): Step =
    known(token)(own => givenUp(enter(token, own, own.holding, now)))

  /** Starts the motors. ArduPilot must be in Guided to take off, so it enters that mode first. */
  def arm(token: Long, now: Instant): Step =
    known(token)(own =>
      guided(own, now).andThen(_.order(token, Command.Arm, now, Vector(1f, 0, 0, 0, 0, 0, 0)))
    )

  /** Stops the motors immediately, even in flight, whatever its mode. */
  def kill(token: Long, now: Instant): Step =
    order(token, Command.Arm, now, Vector(0f, CommonDialect.Force.toFloat, 0, 0, 0, 0, 0))

  /** Takes off, to the autopilot's own height if it has one. */
  def takeoff(token: Long, now: Instant): Step = known(token): own =>
    val numbers = if own.takeoffM.isNaN then Vector.fill(7)(Float.NaN) else Vector.fill(6)(0f) :+ own.takeoffM
    guided(own, now).andThen(_.order(token, Command.Takeoff, now, numbers))

  /** Enters the mode that follows setpoints, if this firmware takes off in that mode. */
  private def guided(own: Firmware, now: Instant): Step =
    if own != Firmware.Copter || mode == own.offboard then Step(this)
    else enter(Silent, own, own.offboard, now)

  private def known(token: Long)(step: Firmware => Step): Step =
    firmware.fold(why => refused(token, s"$name: $why"), step)

  private def enter(token: Long, own: Firmware, wanted: Long, now: Instant): Step =
    order(token, Command.SetMode, now, own.modeNumbers(wanted), Some(wanted))

  private def isOffboard(one: Order): Boolean =
    one.mode.exists(wanted => firmware.exists(_.offboard == wanted))

  /** Stops commanding the vehicle; actions in progress end as replaced. */
  private def givenUp(step: Step): Step =
    val next = step.next
    step.copy(
      next = next.copy(flown = None, asked = Vector.empty),
      answers = step.answers ++ next.asked.map(_.token -> Right(false))
    )

  /** Sends a command until it is answered: at most [[MostTries]] times within one timeout. */
  def order(
      token: Long,
      command: Int,
      now: Instant,
      numbers: Vector[Float],
      mode: Option[Long] = None
  ): Step =
    val one = Order(token, command, numbers, 0, now + settings.timeout, now, None, mode)
    // A newer command of this kind replaces an older one.
    val (older, others) = orders.partition(_.command == command)
    Step(copy(orders = others), answers = older.map(_.token -> Right(false)))
      .andThen(_.copy(orders = others :+ one).due(now))

  def heard(message: Message, now: Instant): Step = copy(heardAt = Some(now)).taken(message, now)

  /** @param reference the clock of all vehicles' times in this flight */
  def inTimeOf(reference: Option[VehicleClock]): Control =
    (clock, reference) match
      case (Some(own), Some(other)) if own ne other => copy(shift = own.shiftTo(other))
      case _                                        => this

  /** Advances time; to be called every [[Control.Tick]]. */
  def passed(now: Instant): Step =
    val (late, waiting) = readers.partition(_.until <= now)
    val first           = Step(
      copy(readers = waiting),
      answers =
        late.map(_.token -> Left(VehicleError.TimedOut(s"$name: no sample within ${inMs(settings.timeout)}")))
    )
    first.andThen(_.ended(now)).andThen(_.due(now)).andThen(one =>
      if now >= one.renewAt then one.send(now) else Step(one)
    )

  private def name = s"system $system"

  private def answered(token: Long, answer: Answer): Step = Step(this, answers = Vector(token -> answer))

  private def refused(token: Long, why: String): Step = answered(token, Left(VehicleError.Refused(why)))

  private def replacing(now: Instant): Control =
    copy(asked =
      asked.dropRight(1).map(one =>
        one.copy(replacedAt = one.replacedAt.orElse(Some(now)))
      ) ++ asked.lastOption
    )

  /** Ends actions whose duration has elapsed, and those whose receipt is overdue. */
  private def ended(now: Instant): Step =
    val (lost, rest) = asked.partition(_.replacedAt.exists(at => now > at + settings.timeout))
    val (done, open) = rest.partition(one => one.replacedAt.isEmpty && now >= one.until)
    Step(
      copy(asked = open, flown = if done.isEmpty then flown else Some(Stay)),
      answers = done.map(_.token -> Right(true)) ++ lost.map(
        _.token -> Left(
          VehicleError.TimedOut(s"$name: no receipt of the next setpoint within ${inMs(settings.timeout)}")
        )
      )
    )

  /** Repeats the setpoint, with a TIMESYNC; without a setpoint, sends only a TIMESYNC. */
  private def send(now: Instant): Step =
    val at       = now.max(lastSync + Span.ofNanos(1))
    val setpoint =
      for
        action <- flown
        known  <- estimate.newest
        out    <- Setpoints.of(action, known.state, originNed, system)
      yield out
    val every: Span = if heardAt.isDefined && flown.isEmpty && !isAligned then Tick else settings.renewEvery
    val next        = copy(lastSync = at, renewAt = now + every)
    Step(next, setpoint.toVector :+ Timesync(0, at.toNanos, system, 1))

  private def taken(message: Message, now: Instant): Step = message match
    case Heartbeat(kind, autopilot, base, custom, _, _) if autopilot != NoAutopilot =>
      val own = Firmware.of(autopilot, kind)
      Step(copy(mode = custom, isArmed = (base & ModeFlag.Armed) != 0, firmware = own))
    case ExtendedSysState(_, landed)       => Step(copy(isOnGround = landed == 1))
    case GpsGlobalOrigin(lat, lon, alt, _) =>
      Step(copy(origin = Some(GeoLocation(lat * 1e-7, lon * 1e-7, Metres(alt / 1000.0)))))
    case Timesync(theirs, ours, _, _) if theirs != 0 =>
      received(Instant.ofNanos(ours), Instant.ofNanos(theirs), now)
    case CommandAck(command, result, _, _, _, _) => acknowledged(command, result, now)
    case Statustext(severity, text, _, _) if severity <= Severity.Warning => explained(text)
    case sample                                                           =>
      val (told, isNew) = estimate.heard(sample)
      val next          = copy(estimate = told)
      if !isNew then Step(next) else next.sampled(now)

  private def received(sentAt: Instant, theirs: Instant, now: Instant): Step =
    // An answer to another peer's request has a time that was never sent.
    if sentAt > lastSync || now.since(sentAt) > Span.ofSeconds(10) then Step(this)
    else
      val known  = clock.fold(VehicleClock.of(sentAt, theirs, now))(_.answered(sentAt, theirs, now))
      val newest = asked.lastIndexWhere(_.sentAt <= sentAt)
      val (replaced, flying) = asked.splitAt(newest.max(0))
      Step(copy(clock = Some(known), asked = flying), answers = replaced.map(_.token -> Right(false)))

  private def sampled(now: Instant): Step =
    (for
      known  <- estimate.newest
      synced <- clock
    yield
      val state = known.state.copy(positionNed = known.state.positionNed + originNed)
      val told  = synced.stamped(state, known.at, now, shift.shift, shift.doubt)
      val place = state.positionNed
      val away  = StrictMath.hypot(place.x, place.y)
      val first = Step(copy(readers = Vector.empty), answers = readers.map(_.token -> Right(told)))
      if (away <= settings.farthestM && -place.z <= settings.highestM) || isOut then first
      else first.andThen(_.leftTheFence(away, -place.z, now))
    ).getOrElse(Step(this))

  private def leftTheFence(awayM: Double, upM: Double, now: Instant): Step =
    val why = s"$name has left the geofence: ${awayM.fixed(0)} m away, ${upM.fixed(0)} m up"
    val out = copy(isOut = true, flown = None, asked = Vector.empty)
    Step(out, answers = asked.map(_.token -> Left(VehicleError.Refused(why))))
      .andThen(one => one.firmware.fold(_ => Step(one), own => one.enter(Silent, own, own.holding, now)))

  private def acknowledged(command: Int, result: Int, now: Instant): Step =
    orders.find(_.command == command) match
      case None                     => Step(this)
      case Some(one) if result == 0 =>
        val entered = one.mode.getOrElse(mode)
        val armed   = if command == Command.Arm then one.numbers(0) == 1 else isArmed
        without(one).copy(mode = entered, isArmed = armed).answered(one.token, Right(true))
      case Some(_) if result == Result.InProgress => Step(this)
      // The vehicle may not have received setpoints yet.
      case Some(one) if isOffboard(one) && one.tries < MostTries => Step(this)
      case Some(one)                                             =>
        Step(changed(one, one.copy(refusal = Some((result, now)))))

  /** Adds the autopilot's status text to the refusal it explains. */
  private def explained(text: String): Step =
    orders.find(_.refusal.isDefined).fold(Step(this))(one => without(one).failed(one, text))

  private def without(one: Order): Control = copy(orders = orders.filter(_ ne one))

  private def changed(one: Order, to: Order): Control =
    copy(orders = orders.map(other => if other eq one then to else other))

  private def failed(one: Order, why: String): Step =
    val error = VehicleError.Refused(s"$name: $why")
    if !isOffboard(one) then answered(one.token, Left(error))
    else Step(copy(flown = None, asked = Vector.empty), answers = asked.map(_.token -> Left(error)))

  /** Sends due commands again, and ends those without tries left. */
  private def due(now: Instant): Step =
    orders.foldLeft(Step(this)): (before, one) =>
      one.refusal match
        case Some((result, at)) if now >= at + TextWithin =>
          before.andThen(_.without(one).failed(one, s"refused (result $result)"))
        case None if now >= one.until && isOffboard(one) =>
          before.andThen(_.without(one).failed(one, "offboard was not entered in time"))
        case None if now >= one.until =>
          val why = s"$name: no answer to command ${one.command} within ${inMs(settings.timeout)}"
          before.andThen(_.without(one).answered(one.token, Left(VehicleError.TimedOut(why))))
        case None if now >= one.sendAt =>
          val again = one.copy(tries = one.tries + 1, sendAt = now + settings.timeout / MostTries.toLong)
          before.andThen(known => Step(known.changed(one, again), Vector(one.message(system))))
        case _ => before

object Control:
  /** The step of a request, by its token, at a time. */
  type Request = (Control, Long, Instant) => Step

  type Answer = Either[VehicleError, Boolean | Stamped[Kinematics]]

  /** A new state, with messages to send.
    *
    * @param answers the answers, by the tokens of their requests
    */
  final case class Step(
      next: Control,
      messages: Vector[Message] = Vector.empty,
      answers: Vector[(Long, Answer)] = Vector.empty
  ):
    private[offboard] def andThen(more: Control => Step): Step =
      val after = more(next)
      Step(after.next, messages ++ after.messages, (answers ++ after.answers).filter(_._1 != Silent))

  /** An action without an answer.
    *
    * @param sentAt the answer to a TIMESYNC of this time or later confirms that the vehicle has received it
    */
  final case class Asked(token: Long, sentAt: Instant, until: Instant, replacedAt: Option[Instant])

  /** A command in progress.
    *
    * @param mode the mode that it sets, if any
    */
  final case class Order(
      token: Long,
      command: Int,
      numbers: Vector[Float],
      tries: Int,
      until: Instant,
      sendAt: Instant,
      refusal: Option[(Int, Instant)],
      mode: Option[Long]
  ):
    private[offboard] def message(system: Int): Message =
      val Vector(p1, p2, p3, p4, p5, p6, p7) = numbers: @unchecked
      CommandLong(system, 1, command, tries, p1, p2, p3, p4, p5, p6, p7)

  val Tick: Span = Span.ofMillis(10)

  /** Maximum number of times that a command is sent within its timeout. */
  val MostTries = 8

  private val MostReaders = 8

  /** Time within which a refusal's status text arrives. */
  private val TextWithin = Span.ofMillis(150)

  /** Token of a request that needs no answer. */
  private[offboard] val Silent = -1L

  /** The action of a vehicle after its action's duration has elapsed. */
  private val Stay = Action.Velocity(Vector3.Zero)

  private def inMs(span: Span): String = s"${span.toMillis.fixed(0)} ms"
