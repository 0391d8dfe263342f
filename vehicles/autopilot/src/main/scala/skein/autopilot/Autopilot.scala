package skein.autopilot

import skein.mavlink.*
import skein.policy.{ActionGuidance, Yaw}
import skein.units.*
import skein.vehicle.{GoTo, Setpoint}

/** The decisions of an autopilot that behaves like PX4, as values: messages and the vehicle's motion go in,
  * answers and the vehicle's setpoint come out. It knows no socket and no clock.
  *
  * Like PX4's, offboard begins only while setpoints arrive, and ends [[Parameters.OffboardLoss]] after the
  * last one: the vehicle then holds its position, as PX4 does without a remote control when so configured
  * (`COM_OBL_RC_ACT`).
  *
  * @param system 1 to 255
  * @param home position of its start: the origin of its own frame
  * @param anchor the position that its mode flies to, own frame
  * @param enteredAt time at which it entered its mode
  * @param heardAt time at which the last setpoint was received
  * @param stillSince while it lands, time since which it stands still
  * @param groundedAt time since which it is armed and on the ground
  * @param hasFlown whether it took off since it was armed
  */
final case class Autopilot(
    system: Int,
    home: GeoLocation,
    mode: FlightMode = FlightMode.Hold,
    isArmed: Boolean = false,
    parameters: Parameters = Parameters(),
    mission: Mission = Mission(),
    upload: Option[Upload] = None,
    anchor: Vector3 = Vector3.Zero,
    yaw: Yaw = Yaw.Still,
    enteredAt: Span = Span.Zero,
    target: Option[OffboardSetpoint] = None,
    heardAt: Option[Span] = None,
    stillSince: Option[Span] = None,
    groundedAt: Span = Span.Zero,
    hasFlown: Boolean = false,
    cruise: Option[Double] = None
) extends Status:
  import Autopilot.*
  import CommonDialect.{Command, Result, Severity}

  /** Handles a message that is addressed to this vehicle, or to all.
    *
    * @param from system and component of the sender
    * @param motion the true motion
    * @param reported the motion for a message of this number; None if sensors have no reading for it
    */
  def heard(
      message: Message,
      from: (system: Int, component: Int),
      motion: VehicleMotion,
      reported: Int => Option[VehicleMotion]
  ): Heard =
    def acknowledged(order: Order) =
      def ack(result: Int) =
        CommandAck(order.command, result, targetSystem = from.system, targetComponent = from.component)
      obey(order, motion, reported) match
        case Left(Refusal(result, why, more)) =>
          Heard(this, Vector(ack(result)), (why +: more).map(text(Severity.Critical, _)))
        case Right(heard) => heard.copy(answers = ack(Result.Accepted) +: heard.answers)
    message match
      case one: CommandLong =>
        val numbers =
          Vector(one.param1, one.param2, one.param3, one.param4, one.param5, one.param6, one.param7)
        acknowledged(Order(one.command, numbers.map(_.toDouble), None))
      case one: CommandInt =>
        val numbers = Vector(one.param1, one.param2, one.param3, one.param4).map(_.toDouble) ++
          Vector(degrees(one.x), degrees(one.y), one.z.toDouble)
        acknowledged(Order(one.command, numbers, Some(one.frame)))
      case Timesync(0, theirs, _, _)       => Heard(this, Vector(Timesync(motion.sinceBoot.toNanos, theirs)))
      case ParamRequestList(_, _)          => Heard(this, parameters.all)
      case ParamRequestRead(_, _, name, n) => Heard(this, parameters.one(name, n).toVector)
      case ParamSet(_, _, name, value, _)  =>
        parameters.set(name, value) match
          case Left(why)           => refused(why)
          case Right((next, told)) => Heard(copy(parameters = next), news = Vector(told))
      case MissionSetCurrent(_, _, seq) =>
        if mission.items.isDefinedAt(seq) then
          val next = copy(mission = mission.from(seq))
          Heard(next, news = Vector(next.mission.told))
        else refused(s"no mission item $seq")
      case other =>
        transfer.heard(other, from, motion.sinceBoot).map(transferred).getOrElse:
          OffboardSetpoint.of(other, home) match
            case None                => Heard(this)
            case Some(Right(target)) => Heard(copy(target = Some(target), heardAt = Some(motion.sinceBoot)))
            case Some(Left(why))     => refused(why)

  /** Advances the autopilot to the motion's time and returns the vehicle's setpoint, which is None if it was
    * never armed. To be called every 20 ms, after all received messages.
    */
  def steer(motion: VehicleMotion): (heard: Heard, setpoint: Option[Setpoint]) =
    val asked         = transferred(transfer.passed(motion.sinceBoot))
    val (after, told) = asked.next.onItsOwn(motion)
    (Heard(after, news = asked.news ++ told), after.goal(motion))

  /** Whether setpoints arrive often enough, by the autopilot's clock. */
  def isCommanded(motion: VehicleMotion): Boolean =
    heardAt.exists(at => (motion.sinceBoot - at).toSeconds <= parameters(Parameters.OffboardLoss))

  private def transfer = MissionTransfer(mission, upload, home)

  private def transferred(told: MissionTransfer.Told): Heard =
    Heard(copy(mission = told.next.mission, upload = told.next.upload), told.answers, told.news)

  private def refused(why: String): Heard = Heard(this, Vector(text(Severity.Critical, why)))

  private def obey(
      order: Order,
      motion: VehicleMotion,
      reported: Int => Option[VehicleMotion]
  ): Either[Refusal, Heard] = order.command match
    case Command.Arm if order.isOne(0)       => arm(motion)
    case Command.Arm                         => disarm(motion, order.numbers(1) == CommonDialect.Force)
    case Command.Terminate if order.isOne(0) => disarm(motion, isForced = true)
    case Command.Takeoff                     =>
      val above = order.numbers(6)
      val down  =
        if above.isFinite && above > home.altitude.value + 0.1 then home.altitude.value - above
        else motion.state.positionNed.z - parameters(Parameters.TakeoffAltitude)
      if math.abs(down) > OffboardSetpoint.Most then
        Left(Refusal(Result.Denied, s"takeoff: no altitude to reach: $above m"))
      else
        enter(FlightMode.Takeoff, motion).map(heard =>
          heard.copy(next = heard.next.copy(anchor = motion.state.positionNed.copy(z = down)))
        )
    case Command.Land            => enter(FlightMode.Land, motion)
    case Command.ReturnToLaunch  => enter(FlightMode.Return, motion)
    case Command.LoiterUnlimited => enter(FlightMode.Hold, motion)
    case Command.SetMode         =>
      val (main, sub) = (order.whole(1), order.whole(2))
      FlightMode
        .of(main, sub)
        .toRight(Refusal(Result.Denied, s"mode $main/$sub unsupported"))
        .flatMap(enter(_, motion))
    case Command.StartMission =>
      val first = order.whole(0)
      for
        entered <- copy(mission = mission.from(first.max(0))).enter(FlightMode.Mission, motion)
      yield entered
    case Command.ChangeSpeed =>
      val speed = order.numbers(1)
      // In MAVLink's common messages, −1 changes nothing.
      if speed == -1 then Right(Heard(this))
      else if speed > 0 && speed <= Parameters.Cruise.most then Right(Heard(copy(cruise = Some(speed))))
      else Left(Refusal(Result.Denied, s"speed: expected up to ${Parameters.Cruise.most} m/s"))
    case Command.Reposition          => reposition(order, motion)
    case Command.GetHome             => Right(Heard(this, Vector(Telemetry.home(this))))
    case Command.RequestCapabilities => Right(Heard(this, Vector(Telemetry.version(this))))
    case Command.RequestMessage      =>
      val id = order.whole(0)
      for
        shown   <- reported(id).toRight(Refusal(Result.Rejected, s"message $id: sensors have no reading"))
        message <- Telemetry.of(id, this, shown)
          .toRight(Refusal(Result.Unsupported, s"message $id unsupported"))
      yield Heard(this, Vector(message))
    case Command.SetMessageInterval =>
      val id     = order.whole(0)
      val micros = order.numbers(1)
      if !Telemetry.intervals.contains(id) then Left(Refusal(Result.Unsupported, s"message $id unsupported"))
      else if !micros.isFinite then Left(Refusal(Result.Denied, s"message $id: the interval is no number"))
      else Right(Heard(this, interval = Some((id, micros))))
    case other => Left(Refusal(Result.Unsupported, s"command $other unsupported"))

  private def arm(motion: VehicleMotion): Either[Refusal, Heard] =
    if isArmed then Right(Heard(this))
    else if mode == FlightMode.Land || mode == FlightMode.Return then
      Left(Refusal(Result.Rejected, s"Arming denied: switch out of ${mode.title} mode first"))
    else
      Right(Heard(
        copy(
          isArmed = true,
          hasFlown = false,
          groundedAt = motion.sinceBoot,
          anchor = motion.state.positionNed,
          cruise = None
        ),
        news = Vector(text(Severity.Info, "Armed by external command"))
      ))

  private def disarm(motion: VehicleMotion, isForced: Boolean): Either[Refusal, Heard] =
    if isArmed && motion.isFlying && !isForced then
      Left(Refusal(Result.Rejected, "Disarming denied: not landed"))
    else
      Right(disarmed(if isForced && motion.isFlying then "Kill: motors are off"
      else "Disarmed by external command"))

  private def disarmed(why: String): Heard = Heard(
    copy(isArmed = false, mode = FlightMode.Hold, stillSince = None, target = None, cruise = None),
    news = if isArmed then Vector(text(Severity.Info, why)) else Vector.empty
  )

  /** Degrees of a COMMAND_INT, whose largest integer stands for none. */
  private def degrees(number: Int) = if number == Int.MaxValue then Double.NaN else number * 1e-7

  private def reposition(order: Order, motion: VehicleMotion): Either[Refusal, Heard] =
    val here = motion.state.positionNed
    // A command without a frame has PX4's: above the sea.
    OffboardSetpoint.heightOf(order.frame.getOrElse(CommonDialect.Frame.Global), order.numbers(6), home) match
      case None           => Left(Refusal(Result.Denied, s"frame ${order.frame.getOrElse(0)} unsupported"))
      case Some(altitude) =>
        val place = GeoLocation(order.numbers(4), order.numbers(5), altitude).nedFrom(home)
        val goal  = Vector3(
          if place.x.isFinite then place.x else here.x,
          if place.y.isFinite then place.y else here.y,
          if place.z.isFinite then place.z else here.z
        )
        val heading = order.numbers(3)
        val isAfar = Vector(goal.x, goal.y, goal.z).exists(metres => math.abs(metres) > OffboardSetpoint.Most)
        val isGlobe = !(math.abs(order.numbers(4)) > 90) && !(math.abs(order.numbers(5)) > 180)
        if isAfar || !isGlobe || math.abs(heading) > OffboardSetpoint.Most then
          Left(Refusal(
            Result.Denied,
            s"reposition: expected a place within ${OffboardSetpoint.Most.toInt} m and a yaw",
            OffboardSetpoint.whereHomeIs(home)
          ))
        else
          enter(FlightMode.Hold, motion).map(heard =>
            heard.copy(next =
              heard.next.copy(
                anchor = goal,
                cruise = Some(order.numbers(0).min(Parameters.Cruise.most)).filter(_ > 0).orElse(cruise),
                yaw = towards(heading)
              )
            )
          )

  private def enter(wanted: FlightMode, motion: VehicleMotion): Either[Refusal, Heard] =
    def rejected(why: String) = Left(Refusal(Result.Rejected, s"Switching to ${wanted.title} denied: $why"))
    wanted match
      case FlightMode.Offboard if !isCommanded(motion) => rejected("no offboard setpoints")
      case FlightMode.Mission if mission.items.isEmpty => rejected("no valid mission available")
      case FlightMode.Mission if !mission.items.isDefinedAt(mission.current) && !mission.isOver =>
        rejected(s"no mission item ${mission.current}")
      case FlightMode.Takeoff | FlightMode.Mission if !isArmed => rejected("vehicle is disarmed")
      case _                                                   =>
        val again = if wanted == FlightMode.Mission && mission.isOver then mission.from(0) else mission
        Right(Heard(
          copy(
            mode = wanted,
            enteredAt = motion.sinceBoot,
            // A vehicle that already holds keeps its position.
            anchor = if mode == FlightMode.Hold && wanted == mode then anchor else motion.state.positionNed,
            yaw = Yaw.Still,
            stillSince = None,
            mission = again
          )
        ))

  /** Applies the changes that the autopilot makes without a command. */
  private def onItsOwn(motion: VehicleMotion): (Autopilot, Vector[Message]) =
    val now = motion.sinceBoot
    if !isArmed then (this, Vector.empty)
    else
      val noted =
        if motion.isFlying then copy(hasFlown = true, groundedAt = now)
        else this
      val onGround = (now - noted.groundedAt).toSeconds
      val limit = parameters(if noted.hasFlown then Parameters.DisarmLanded else Parameters.DisarmPreflight)
      if !motion.isFlying && limit >= 0 && onGround > limit && !noted.isRising then
        val off = noted.disarmed("Disarmed by auto preflight or landing detection")
        (off.next, off.news)
      else noted.proceed(motion)

  /** Whether the mode makes the vehicle rise from the ground as soon as its rotors have spun up. */
  private def isRising: Boolean = mode == FlightMode.Takeoff || mode == FlightMode.Mission

  private def proceed(motion: VehicleMotion): (Autopilot, Vector[Message]) =
    val state = motion.state
    val here  = state.positionNed
    mode match
      case FlightMode.Offboard if !isCommanded(motion) =>
        (holding(motion), Vector(text(Severity.Critical, "Offboard control lost: switching to Hold")))
      case FlightMode.Takeoff if math.abs(here.z - anchor.z) < NearM =>
        (copy(mode = FlightMode.Hold, enteredAt = motion.sinceBoot), Vector.empty)
      case FlightMode.Return
          if (here - Vector3(0, 0, here.z)).norm < NearM && math.abs(state.velocityNed.z) < 1 =>
        (copy(mode = FlightMode.Land, anchor = Vector3.Zero.copy(z = here.z)), Vector.empty)
      case FlightMode.Land =>
        val isStill = math.abs(state.velocityNed.z) < StillMps
        (copy(stillSince = if isStill then stillSince.orElse(Some(motion.sinceBoot)) else None), Vector.empty)
      case FlightMode.Mission => followed(motion)
      case _                  => (this, Vector.empty)

  private def holding(motion: VehicleMotion): Autopilot = copy(
    mode = FlightMode.Hold,
    enteredAt = motion.sinceBoot,
    anchor = motion.state.positionNed,
    yaw = Yaw.Still
  )

  private def followed(motion: VehicleMotion): (Autopilot, Vector[Message]) = mission.item match
    case None =>
      (holding(motion), Vector(text(Severity.Info, "Mission finished, loitering")))
    case Some(item) =>
      import Command.*
      val now                      = motion.sinceBoot
      val here                     = motion.state.positionNed
      def reached(next: Autopilot) =
        val last = next.mission
        (next, Vector(MissionItemReached(mission.current), last.told))
      def after(seconds: Double) =
        val since = mission.reachedAt.getOrElse(now)
        if (now - since).toSeconds >= seconds then reached(copy(mission = mission.next))
        else (copy(mission = mission.copy(reachedAt = Some(since))), Vector.empty)
      item.command match
        case ChangeSpeed =>
          reached(copy(
            mission = mission.next,
            cruise = Some(item.param2.toDouble.min(Parameters.Cruise.most)).filter(_ > 0).orElse(cruise)
          ))
        case Delay          => after(item.param1)
        case ReturnToLaunch =>
          reached(copy(mission = mission.next, mode = FlightMode.Return, enteredAt = now))
        case command =>
          val place = Mission.place(item, home, anchor)
          val goal  = if command == Land then place.copy(z = here.z) else place
          val near  = math.max(
            if item.param2 > 0 && command == Waypoint then item.param2.toDouble
            else parameters(Parameters.AcceptanceRadius),
            NearM
          )
          if (here - goal).norm > (if command == Takeoff then NearM else near) && mission.reachedAt.isEmpty
          then
            (this, Vector.empty)
          else
            command match
              case Land =>
                reached(copy(mission = mission.next, mode = FlightMode.Land, anchor = goal, enteredAt = now))
              case LoiterUnlimited => after(Double.PositiveInfinity)
              case LoiterTime      => after(item.param1)
              case Waypoint        => after(if item.param1.isFinite then item.param1.toDouble.max(0) else 0)
              case _               =>
                val next = copy(mission = mission.next, anchor = here)
                reached(next)

  private def goal(motion: VehicleMotion): Option[Setpoint] =
    val here  = motion.state.positionNed
    val speed = MetresPerSecond(cruise.getOrElse(parameters(Parameters.Cruise)).max(0.1))
    def to(place: Vector3, yaw: Yaw) =
      val velocity = GoTo.velocityNed(here, motion.state.velocityNed, place, speed)
      ActionGuidance.turned(Setpoint.velocity(velocity.x, velocity.y, velocity.z), yaw, Vector3.Zero)
    def over(place: Vector3, downMps: Double) =
      val velocity = GoTo.velocityNed(here, motion.state.velocityNed, place.copy(z = here.z), speed)
      Setpoint.velocity(velocity.x, velocity.y, downMps)
    if !isArmed then Some(Setpoint.Disarmed)
    else
      Some(mode match
        case FlightMode.Offboard => target.fold(Setpoint.Armed)(OffboardSetpoint.setpoint(_, motion, speed))
        case FlightMode.Takeoff  =>
          val up = parameters(Parameters.TakeoffSpeed)
          over(anchor, ((anchor.z - here.z) * 1.2).max(-up).min(up))
        case FlightMode.Hold | FlightMode.Land if !motion.isFlying => Setpoint.Armed
        case FlightMode.Hold                                       => to(anchor, yaw)
        case FlightMode.Land                                       =>
          val hasTouched = stillSince.exists(since => (motion.sinceBoot - since) >= TouchedAfter)
          if hasTouched then Setpoint.Armed else over(anchor, parameters(Parameters.LandSpeed))
        case FlightMode.Return =>
          val height = -parameters(Parameters.ReturnAltitude)
          val away   = here.copy(z = 0).norm
          // First up, then across; a vehicle that is near already descends in place.
          if away > NearHomeM && here.z > height + 1 then over(anchor, -parameters(Parameters.TakeoffSpeed))
          else to(Vector3.Zero.copy(z = here.z), Yaw.Still)
        case FlightMode.Mission if !motion.isFlying =>
          Setpoint.velocity(0, 0, -parameters(Parameters.TakeoffSpeed))
        case FlightMode.Mission =>
          mission.item.fold(to(anchor, yaw)): item =>
            item.command match
              case Command.Waypoint | Command.LoiterTime | Command.LoiterUnlimited | Command.Takeoff =>
                to(Mission.place(item, home, anchor), yawOf(item))
              case Command.Land => to(Mission.place(item, home, anchor).copy(z = here.z), yawOf(item))
              case _            => to(anchor, yaw))

  private def yawOf(item: MissionItemInt): Yaw = towards(math.toRadians(item.param4))

  /** A turn to this heading; none where a message leaves it out. */
  private def towards(headingRad: Double): Yaw =
    if headingRad.isFinite then Yaw.Towards(Radians(headingRad)) else Yaw.Still

object Autopilot:
  /** The result of a message or of passing time.
    *
    * @param answers messages to the sender
    * @param news messages to every peer
    * @param interval the message that the sender requests at this interval, µs: −1 never, 0 as usual
    */
  final case class Heard(
      next: Autopilot,
      answers: Vector[Message] = Vector.empty,
      news: Vector[Message] = Vector.empty,
      interval: Option[(Int, Double)] = None
  )

  /** A command with its seven parameters; positions in degrees.
    *
    * @param frame the frame of its position, if it names one
    */
  private final case class Order(command: Int, numbers: Vector[Double], frame: Option[Int]):
    def whole(index: Int): Int     = if numbers(index).isFinite then numbers(index).toInt else 0
    def isOne(index: Int): Boolean = numbers(index) == 1

  /** The refusal of a command, with its reason.
    *
    * @param more further lines of the reason
    */
  private final case class Refusal(result: Int, why: String, more: Vector[String] = Vector.empty)

  /** A status text for a person, in one piece. */
  private[autopilot] def text(severity: Int, line: String): Message = Statustext(severity, line.take(50))

  /** Position tolerances, m, and the speed below which the vehicle stands, m/s. */
  private val NearM     = 0.3
  private val NearHomeM = 3.0
  private val StillMps  = 0.05

  /** Time of standing still after which a landing vehicle is on the ground. */
  private val TouchedAfter = Span.ofMillis(500)
