package skein.offboard

import skein.mavlink.*
import skein.policy.Action
import skein.port.VehicleError
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

/** One vehicle's control, one event at a time. The vehicle's clock is 1000 s behind the controller's. */
class ControlSuite extends munit.FunSuite:
  private def at(ms: Double): Instant     = Instant.ofNanos(1_000_000_000_000L) + Span.ofMillis(ms)
  private def theirs(ms: Double): Instant = Instant.ofNanos(0) + Span.ofMillis(ms)
  private val forward                     = Action.VelocityAt(5, 0, Metres(-20))
  private val aside                       = Action.VelocityAt(0, 5, Metres(-20))
  private val offboard                    = 6L << 16
  private val hold                        = 4L << 16 | 3L << 24
  private def heartbeat(mode: Long, armed: Boolean, autopilot: Int = 12, kind: Int = 2) =
    Heartbeat(kind, autopilot, if armed then 209 else 81, mode, 4, 3)
  private def sample(ms: Double, north: Double = 0, down: Double = -20) = Odometry(
    (ms * 1000).toLong,
    1,
    12,
    north.toFloat,
    0,
    down.toFloat,
    Vector(1, 0, 0, 0),
    0,
    0,
    0,
    0,
    0,
    0,
    Vector.empty,
    Vector.empty
  )

  extension (step: Control.Step)
    private def and(more: Control => Control.Step): Control.Step = step.andThen(more)

  private def known(mode: Long = offboard, armed: Boolean = true): Control =
    Control(1)
      .heard(heartbeat(mode, armed), at(0))
      .and(_.heard(GpsGlobalOrigin(0, 0, 0), at(0)))
      .and(_.heard(sample(0), at(20)))
      .and(_.passed(at(20)))
      .next

  private def syncs(step: Control.Step): Vector[Long] =
    step.messages.collect { case Timesync(0, ours, _, _) => ours }

  private def velocities(step: Control.Step): Vector[(Float, Float)] =
    step.messages.collect { case one: SetPositionTargetLocalNed => (one.vx, one.vy) }

  test(
    "a setpoint and a TIMESYNC are sent immediately, then every 100 ms until the action's time has elapsed"
  ):
    val sent = known().act(7, forward, Span.ofMillis(250), at(100))
    assertEquals(velocities(sent), Vector((5f, 0f)))
    assertEquals(syncs(sent).size, 1)
    val (_, sends, answers) =
      (1 to 40).foldLeft((sent.next, Vector.empty[Any], Vector.empty[Any])): (before, tick) =>
        val step = before._1.passed(at(100 + 10 * tick))
        (step.next, before._2 ++ velocities(step), before._3 ++ step.answers)
    // Afterwards it is commanded to stay, until another action is requested.
    assertEquals(sends, Vector.fill(2)((5f, 0f)) ++ Vector.fill(2)((0f, 0f)))
    assertEquals(answers, Vector((7L, Right(true))))

  test("an action is replaced when the receipt of its successor is confirmed, not before"):
    val first  = known().act(1, forward, Span.ofSeconds(10), at(100))
    val second = first.next.act(2, aside, Span.ofSeconds(10), at(200))
    assertEquals(second.answers, Vector.empty)
    val early = second.next.heard(Timesync(theirs(120).toNanos, syncs(first).head), at(230))
    assertEquals(early.answers, Vector.empty)
    val late = early.next.heard(Timesync(theirs(220).toNanos, syncs(second).head), at(240))
    assertEquals(late.answers, Vector(1L -> Right(false)))

  test("the receipt of a repetition replaces a lost one, and without any the action is uncertain"):
    val two = known().act(
      1,
      forward,
      Span.ofSeconds(10),
      at(100)
    ).next.act(2, aside, Span.ofSeconds(10), at(200)).next
    val renewed = two.passed(at(301))
    val receipt = renewed.next.heard(Timesync(theirs(310).toNanos, syncs(renewed).head), at(330))
    assertEquals(receipt.answers, Vector(1L -> Right(false)))
    two.passed(at(1300)).answers match
      case Vector((1L, Left(error: VehicleError.TimedOut))) => assert(!error.isCertain)
      case other                                            => fail(other.toString)

  test("offboard is requested after the first setpoint, and again until it is granted"):
    val sent = known(hold).act(1, forward, Span.ofSeconds(10), at(100))
    assertEquals(velocities(sent).size, 1)
    def modes(step: Control.Step) =
      step.messages.collect { case one: CommandLong if one.command == 176 => one.param2 }
    val asked = sent.and(_.passed(at(110)))
    assertEquals(modes(asked), Vector(6f))
    val denied = asked.next.heard(CommandAck(176, 1), at(140))
    assertEquals(modes(denied.next.passed(at(240))), Vector(6f))
    assertEquals(denied.next.heard(CommandAck(176, 0), at(260)).next.mode, offboard)

  test("a refusal includes the autopilot's own text"):
    val asked =
      known(hold, armed = false).order(3, CommonDialect.Command.Arm, at(100), Vector(1, 0, 0, 0, 0, 0, 0))
    val denied = asked.next.heard(CommandAck(400, 1), at(130))
    assertEquals(denied.answers, Vector.empty)
    assertEquals(
      denied.next.heard(Statustext(2, "Arming denied: no GPS"), at(131)).answers,
      Vector(3L -> Left(VehicleError.Refused("system 1: Arming denied: no GPS")))
    )
    assertEquals(
      denied.next.passed(at(300)).answers,
      Vector(3L -> Left(VehicleError.Refused("system 1: refused (result 1)")))
    )

  test("a vehicle that is disarmed, or in a mode chosen by another, is not controlled"):
    for control <- Seq(known(armed = false), known(4L << 16 | 5L << 24), known(1L << 16)) do
      val step = control.act(1, forward, Span.ofSeconds(1), at(100))
      assert(step.messages.isEmpty && step.answers.exists(_._2.left.exists(_.isCertain)), step.toString)

  test(
    "ArduCopter is sent Guided (4) to take off and move, and Brake (17) to hover; in RTL it is left alone"
  ):
    def at100(mode: Long, armed: Boolean = true) =
      known().heard(heartbeat(mode, armed, autopilot = 3), at(50)).next
    def modes(step: Control.Step) =
      step.messages.collect {
        case one: CommandLong if one.command == 176 => (one.param1, one.param2, one.param3)
      }
    assertEquals(modes(at100(17).act(1, forward, Span.ofSeconds(1), at(100))), Vector((1f, 4f, 0f)))
    assertEquals(modes(at100(4).act(1, forward, Span.ofSeconds(1), at(100))), Vector.empty)
    assertEquals(modes(at100(4).hover(1, at(100))), Vector((1f, 17f, 0f)))
    val takenOff = at100(0).takeoff(2, at(100))
    assertEquals(
      takenOff.messages.collect { case one: CommandLong => (one.command, one.param2, one.param7) },
      Vector((176, 4f, 0f), (22, 0f, 2.5f))
    )
    assertEquals(takenOff.next.heard(CommandAck(176, 0), at(120)).next.mode, 4L)
    val taken = at100(6).act(1, forward, Span.ofSeconds(1), at(100))
    assertEquals(
      taken.answers,
      Vector(1L -> Left(VehicleError.Refused("system 1 is in RTL: somebody else has taken it over")))
    )

  test("an autopilot with unknown modes is neither armed nor controlled, and the refusal names it"):
    for (autopilot, kind, named) <- Seq((0, 2, "autopilot 0"), (3, 1, "type 1")) do
      val stranger = known().heard(heartbeat(offboard, armed = true, autopilot, kind), at(50)).next
      for step <- Seq(
          stranger.act(1, forward, Span.ofSeconds(1), at(100)),
          stranger.hover(1, at(100)),
          stranger.arm(1, at(100)),
          stranger.takeoff(1, at(100))
        )
      do
        assertEquals(step.messages, Vector.empty)
        assert(step.answers.exists(_._2.left.exists(_.message.contains(named))), step.answers.toString)

  test("a command without an answer is sent eight times, then given up"):
    val begun          = known().order(3, CommonDialect.Command.Arm, at(100), Vector.fill(7)(1f))
    val (_, sent, got) =
      (1 to 110).foldLeft((begun.next, begun.messages.size, begun.answers)): (before, tick) =>
        val step = before._1.passed(at(100 + 10 * tick))
        (step.next, before._2 + step.messages.count(_.isInstanceOf[CommandLong]), before._3 ++ step.answers)
    assertEquals(sent, 8)
    assert(
      got.exists(_._2.left.exists { case VehicleError.TimedOut(_) => true; case _ => false }),
      got.toString
    )

  test("kill stops the motors in the air, for any autopilot and in any mode"):
    val loiter = known(4L << 16 | 3L << 24).heard(heartbeat(3, armed = true, autopilot = 0), at(50)).next
    for control <- Seq(known(), loiter) do
      val killed = control.kill(5, at(100))
      assertEquals(
        killed.messages,
        Vector(CommandLong(1, 1, 400, 0, 0, 21196, 0, 0, 0, 0, 0))
      )
      val done = killed.next.heard(CommandAck(400, 0), at(130))
      assertEquals(done.answers, Vector(5L -> Right(true)))
      assert(!done.next.isArmed)

  test("clocks are aligned every 10 ms before a vehicle is ready, and every 100 ms afterwards"):
    val begun             = known().copy(settings = OffboardSettings(exchanges = 5))
    val (aligned, counts) =
      (1 to 50).foldLeft((begun, Vector.empty[Int])): (before, tick) =>
        val now  = at(20 + 10 * tick)
        val step = before._1.passed(now)
        val back = syncs(step).foldLeft(step.next): (control, sent) =>
          assertEquals(control.isReady, control.clock.exists(_.exchanges >= 5))
          control.heard(Timesync(theirs(20 + 10 * tick).toNanos, sent), now).next
        (back, before._2 :+ syncs(step).size)
    assert(aligned.isReady)
    // One more had been sent when the fifth was answered.
    assertEquals(counts.take(7).sum, 6)
    assert((4 to 5).contains(counts.drop(7).sum), counts.toString)

  test("the information that a vehicle has not sent yet is listed"):
    val unheard = Control(1, OffboardSettings(exchanges = 5))
    assertEquals(unheard.missing, Vector("any message"))
    val heard = unheard.heard(heartbeat(offboard, true), at(10)).next
    assertEquals(
      heard.missing,
      Vector(
        "GPS_GLOBAL_ORIGIN",
        "answers to TIMESYNC (0 of 5 came)",
        "ODOMETRY, or LOCAL_POSITION_NED and ATTITUDE_QUATERNION"
      )
    )

  test("a sample answers all waiting readings, in the flight's frame, with TIMESYNC's bounds on its time"):
    val synced =
      known().copy(originNed = Vector3(10, 0, 0)).heard(Timesync(theirs(30).toNanos, at(15).toNanos), at(50))
    // Its request was sent at 20 ms at the earliest.
    val step =
      synced.next.copy(lastSync = at(20)).heard(Timesync(theirs(30).toNanos, at(20).toNanos), at(50)).next
        .read(4, at(60)).next.heard(sample(70, north = 3), at(85))
    step.answers match
      case Vector((4L, Right(told: Stamped[Kinematics @unchecked]))) =>
        assertEquals(told.value.positionNed, Vector3(13, 0, -20))
        assertEquals((told.validAt, told.sentAt, told.receivedAt), (theirs(70), at(60), at(85)))
      case other => fail(other.toString)

  test("a vehicle that leaves the geofence holds its position and accepts no more actions"):
    val flying = known().heard(Timesync(theirs(1).toNanos, 0), at(20)).next.copy(
      clock = Some(VehicleClock.of(at(0), theirs(5), at(10)))
    )
    val out =
      flying.act(1, forward, Span.ofSeconds(10), at(100)).next.heard(sample(100, north = 1001), at(130))
    assert(out.answers.exists(_._2.left.exists(_.message.contains("geofence"))), out.toString)
    assert(out.messages.exists {
      case one: CommandLong => one.command == 176 && one.param2 == 4; case _ => false
    })
    assert(out.next.act(2, forward, Span.ofSeconds(1), at(140)).answers.head._2.isLeft)

  test("the bounds of the clocks' offset that follow from samples' stamps are valid for any delays"):
    val random  = scala.util.Random(3)
    var clock   = VehicleClock.of(at(0), theirs(20), at(40))
    var aligned = Option.empty[ClockAlignment]
    for step <- 1 to 500 do
      val now               = 100.0 * step
      def leg               = 5 + 60 * random.nextDouble()
      val (out, back, push) = (leg, leg, leg)
      clock = clock.answered(at(now), theirs(now + out), at(now + out + back))
      val told = clock.stamped((), theirs(now + 50), at(now + 50 + push), Span.Zero, Span.Zero)
      aligned = Some(aligned.fold(ClockAlignment.of(told))(_.updated(told)))
    val found = aligned.get
    assertEquals(found.restarts, 0)
    assert(found.lower <= Span.ofSeconds(1000) && Span.ofSeconds(1000) <= found.upper, found.toString)

  test("times are on the clock that the vehicles share, and with two clocks on the first vehicle's clock"):
    val one   = VehicleClock.of(at(0), theirs(20), at(40))
    val same  = VehicleClock.of(at(5), theirs(15), at(35))
    val other = VehicleClock.of(at(0), theirs(520), at(40))
    assertEquals(same.shiftTo(one).shift, Span.Zero)
    assertEquals(other.shiftTo(one).shift, Span.ofMillis(-500))
