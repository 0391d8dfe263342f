package skein.autopilot

import skein.mavlink.*
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.{HorizontalMode, Setpoint, VerticalMode}

/** An autopilot's decisions, one message and one vehicle state at a time. */
class AutopilotSuite extends munit.FunSuite:
  private val home  = GeoLocation(47.641468, -122.140165, Metres(122))
  private val gcs   = (system = 245, component = 190)
  private val fresh = Autopilot(1, home)

  private def at(
      seconds: Double,
      place: Vector3 = Vector3.Zero,
      flying: Boolean = false,
      velocity: Vector3 = Vector3.Zero
  ) = VehicleMotion(
    Span.ofSeconds(seconds),
    Kinematics(place, velocity, Quaternion.Identity, Vector3.Zero),
    flying
  )

  private def command(number: Int, numbers: Float*): Message =
    val all = numbers.padTo(7, 0f)
    CommandLong(1, 1, number, 0, all(0), all(1), all(2), all(3), all(4), all(5), all(6))

  private val arm     = command(400, 1)
  private val takeoff =
    command(22, Float.NaN, Float.NaN, Float.NaN, Float.NaN, Float.NaN, Float.NaN, Float.NaN)
  private val offboard = command(176, 1, 6, 0)

  private def velocity(north: Float, mask: Int = 0xdc7): Message =
    SetPositionTargetLocalNed(0, 1, 1, 1, mask, 0, 0, 0, north, 0, 0, 0, 0, 0, 0, 0)

  extension (autopilot: Autopilot)
    private def told(message: Message, motion: VehicleMotion): Autopilot.Heard =
      autopilot.heard(message, gcs, motion, _ => Some(motion))
    private def flown(motion: VehicleMotion): Autopilot = autopilot.steer(motion).heard.next

  private def results(heard: Autopilot.Heard): Vector[Int] = heard.answers.collect { case ack: CommandAck =>
    ack.result
  }
  private def texts(messages: Vector[Message]): Vector[String] = messages.collect { case text: Statustext =>
    text.text
  }

  private val inAir =
    val armed = fresh.told(arm, at(1)).next
    armed.told(takeoff, at(2)).next.flown(at(5, Vector3(0, 0, -2.5), flying = true))

  test("a vehicle arms, climbs to the height of its parameter, and holds it"):
    val armed = fresh.told(arm, at(1))
    assertEquals((results(armed), armed.next.isArmed), (Vector(0), true))
    val rising = armed.next.told(takeoff, at(2)).next
    assertEquals(rising.mode, FlightMode.Takeoff)
    val up = rising.steer(at(2.02)).setpoint.get
    assertEquals((up.vertical, up.third), (VerticalMode.Velocity, -1.5))
    assertEquals(rising.flown(at(4, Vector3(0, 0, -1.5), flying = true)).mode, FlightMode.Takeoff)
    assertEquals(inAir.mode, FlightMode.Hold)

  test("takeoff unarmed, disarming in the air and a missing mission are refused with a reason"):
    for (autopilot, message, motion, why) <- Seq(
        (fresh, takeoff, at(1), "Switching to Takeoff denied: vehicle is disarmed"),
        (inAir, command(400, 0), at(6, flying = true), "Disarming denied: not landed"),
        (
          inAir,
          command(300),
          at(6, flying = true),
          "Switching to Mission denied: no valid mission available".take(50)
        ),
        (
          inAir,
          offboard,
          at(6, flying = true),
          "Switching to Offboard denied: no offboard setpoints".take(50)
        ),
        (inAir, command(31000), at(6, flying = true), "command 31000 unsupported")
      )
    do
      val heard = autopilot.told(message, motion)
      assert(results(heard).forall(_ != 0) && results(heard).nonEmpty, why)
      assertEquals(texts(heard.news), Vector(why))
      assertEquals(heard.next, autopilot)

  test("a kill stops the motors in the air"):
    val dead = inAir.told(command(400, 0, 21196), at(6, flying = true)).next
    assertEquals(dead.isArmed, false)
    assertEquals(dead.steer(at(6.02, flying = true)).setpoint, Some(Setpoint.Disarmed))

  test("offboard begins only while setpoints arrive, and ends a second after the last one"):
    val streaming = inAir.told(velocity(3), at(6, flying = true)).next
    val flying    = streaming.told(offboard, at(6.1, flying = true)).next
    assertEquals(flying.mode, FlightMode.Offboard)
    val setpoint = flying.steer(at(6.9, flying = true)).setpoint.get
    assertEquals(
      (setpoint.horizontal, setpoint.first, setpoint.vertical),
      (HorizontalMode.Velocity, 3.0, VerticalMode.Velocity)
    )
    assertEquals(flying.flown(at(7.0, flying = true)).mode, FlightMode.Offboard)
    val (heard, _) = flying.steer(at(7.01, Vector3(9, 0, -5), flying = true))
    assertEquals((heard.next.mode, heard.next.anchor), (FlightMode.Hold, Vector3(9, 0, -5)))
    assertEquals(texts(heard.news), Vector("Offboard control lost: switching to Hold"))

  test("a horizontal velocity at an altitude becomes the setpoint of AirSim's moveByVelocityZ"):
    val message = SetPositionTargetLocalNed(0, 1, 1, 1, 0xde3, 0, 0, -20, 4, 1, 0, 0, 0, 0, 0, 0)
    val flying  = inAir.told(message, at(6, flying = true)).next.told(offboard, at(6, flying = true)).next
    assertEquals(flying.steer(at(6.02, flying = true)).setpoint, Some(Setpoint.velocityZ(4, 1, -20)))

  test("setpoints of NaN, and empty ones, are refused and change nothing"):
    val streaming = inAir.told(velocity(3), at(6, flying = true)).next
    for bad <- Seq(velocity(Float.PositiveInfinity), velocity(3, 0xfff), velocity(1e9f)) do
      val heard = streaming.told(bad, at(6.1, flying = true))
      assertEquals(heard.next, streaming)
      assertEquals(texts(heard.answers).size, 1)

  test("a vehicle that does not take off, or has landed, is disarmed"):
    val armed = fresh.told(arm, at(1)).next
    assertEquals(armed.flown(at(10.9)).isArmed, true)
    assertEquals(armed.flown(at(11.1)).isArmed, false)
    val landing = inAir.told(command(21), at(6, flying = true)).next
    val still   = landing.flown(at(8, flying = true)).flown(at(8.1, flying = true))
    assertEquals(still.steer(at(8.6, flying = true)).setpoint, Some(Setpoint.Armed))
    assertEquals(still.flown(at(8.7, flying = true)).flown(at(10.8)).isArmed, false)

  private def item(seq: Int, number: Int, northM: Double, up: Float): MissionItemInt =
    val place = home.locate(Vector3(northM, 0, 0))
    MissionItemInt(
      1,
      1,
      seq,
      6,
      number,
      0,
      1,
      0,
      0,
      0,
      Float.NaN,
      (place.latitudeDeg * 1e7).round.toInt,
      (place.longitudeDeg * 1e7).round.toInt,
      up
    )

  test("a mission is uploaded item by item, read back unchanged, and flown to its end"):
    val items   = Vector(item(0, 16, 20, 5), item(1, 178, 0, 0).copy(param2 = 2), item(2, 16, 40, 5))
    val counted = inAir.told(MissionCount(1, 1, 3), at(6, flying = true))
    assertEquals(counted.answers, Vector(MissionRequestInt(245, 190, 0)))
    val (loaded, asked) = items.foldLeft((counted.next, Vector.empty[Message])): (before, item) =>
      val heard = before._1.told(item, at(6, flying = true))
      (heard.next, heard.answers)
    assertEquals(asked, Vector(MissionAck(245, 190, 0)))
    // A sender that missed the acknowledgement sends its last item once more.
    assertEquals(loaded.told(items.last, at(6)).answers, Vector(MissionAck(245, 190, 0)))
    assertEquals(loaded.told(items.head, at(6)).answers, Vector(MissionAck(245, 190, 13)))
    assertEquals(loaded.told(MissionRequestList(1, 1), at(6)).answers, Vector(MissionCount(245, 190, 3)))
    val flying   = loaded.told(command(300), at(7, flying = true)).next
    val underWay = flying.flown(at(8, Vector3(10, 0, -5), flying = true))
    assertEquals(underWay.mission.current, 0)
    val first = underWay.flown(at(9, Vector3(19, 0, -5), flying = true))
    assertEquals(first.mission.current, 1)
    val second = first.flown(at(9.1, Vector3(19, 0, -5), flying = true))
    assertEquals((second.mission.current, second.cruise), (2, Some(2.0)))
    val there = second.flown(at(20, Vector3(40, 0, -5), flying = true))
    val after = there.steer(at(20.1, Vector3(40, 0, -5), flying = true)).heard
    assertEquals(
      (after.next.mode, texts(after.news)),
      (FlightMode.Hold, Vector("Mission finished, loitering"))
    )

  test("a speed of −1 changes nothing, none is above the greatest, and a wait without end is refused"):
    def flown(speed: Float) =
      val items   = Vector(item(0, 178, 0, 0).copy(param2 = 3), item(1, 178, 0, 0).copy(param2 = speed))
      val counted = inAir.told(MissionCount(1, 1, 2), at(6, flying = true)).next
      val loaded  = items.foldLeft(counted)((before, item) => before.told(item, at(6, flying = true)).next)
      val flying  = loaded.told(command(300), at(7, flying = true)).next
      flying.flown(at(8, flying = true)).flown(at(8.1, flying = true)).cruise
    assertEquals((flown(-1), flown(200)), (Some(3.0), Some(20.0)))
    val counted = inAir.told(MissionCount(1, 1, 1), at(6, flying = true)).next
    for command <- Seq(19, 93) do
      val waits = counted.told(item(0, command, 0, 5).copy(param1 = Float.NaN), at(6, flying = true))
      assertEquals(texts(waits.news), Vector("mission item 0: its time is no number"))

  test("a missing item is requested again ten times, and an item that cannot be flown is refused"):
    val counted    = inAir.told(MissionCount(1, 1, 2), at(6, flying = true)).next
    val (heard, _) = counted.steer(at(6.3, flying = true))
    assertEquals(heard.news, Vector(MissionRequestInt(245, 190, 0)))
    val silent = (1 to 11).foldLeft(counted)((one, turn) => one.flown(at(6 + 0.3 * turn, flying = true)))
    assertEquals(silent.upload, None)
    val refused = counted.told(item(0, 203, 0, 5), at(6, flying = true))
    assertEquals(refused.answers, Vector(MissionAck(245, 190, 3)))
    assertEquals(texts(refused.news), Vector("mission item 0: command 203 unsupported"))
    assertEquals(
      inAir.told(MissionCount(1, 1, 1001), at(6)).answers,
      Vector(MissionAck(245, 190, 4))
    )

  test("a position far from home is refused with a message that names home and the setting that moves it"):
    val zurich  = (latitude = 473_977_420, longitude = 85_455_940)
    val item    = this.item(0, 16, 20, 5).copy(x = zurich.latitude, y = zurich.longitude)
    val mission =
      inAir.told(MissionCount(1, 1, 1), at(6, flying = true)).next.told(item, at(6, flying = true))
    val home = Vector("home is 47.641468, -122.140165", "OriginGeopoint in settings.json sets home")
    assertEquals(mission.answers, Vector(MissionAck(245, 190, 5)))
    assertEquals(texts(mission.news), "mission item 0: 8430 km from home, at most 20" +: home)
    assertEquals(mission.next.mission.items, Vector.empty)
    assert(texts(mission.news).forall(_.length < 50))
    val goto = CommandInt(1, 1, 5, 192, 0, 0, -1, 0, 0, 0, zurich.latitude, zurich.longitude, 500)
    val told = texts(inAir.told(goto, at(6, flying = true)).news)
    assertEquals(told.drop(1), home)
    val near = this.item(0, 16, 19_000, 5)
    val took = inAir.told(MissionCount(1, 1, 1), at(6, flying = true)).next.told(near, at(6, flying = true))
    assertEquals(took.answers, Vector(MissionAck(245, 190, 0)))
    val here = near.copy(x = 0, y = 0)
    val held = inAir.told(MissionCount(1, 1, 1), at(6, flying = true)).next.told(here, at(6, flying = true))
    assertEquals(held.answers, Vector(MissionAck(245, 190, 0)))

  test("TIMESYNC is answered by the autopilot's own clock, and no unrequested time is sent"):
    assertEquals(fresh.told(Timesync(0, 77), at(2)).answers, Vector(Timesync(2_000_000_000L, 77)))
    assertEquals(fresh.told(Timesync(5, 77), at(2)).answers, Vector.empty)

  test("parameters are listed and set within their limits, and integers are encoded in a float's bits"):
    assertEquals(fresh.told(ParamRequestList(1, 1), at(1)).answers.size, Parameters.known.size)
    val set = fresh.told(ParamSet(1, 1, "MIS_TAKEOFF_ALT", 7, 9), at(1)).next
    assertEquals(set.parameters(Parameters.TakeoffAltitude), 7.0)
    assertEquals(fresh.told(ParamSet(1, 1, "MIS_TAKEOFF_ALT", Float.NaN, 9), at(1)).next, fresh)
    fresh.told(ParamRequestRead(1, 1, "SYS_AUTOSTART", -1), at(1)).answers match
      case Vector(value: ParamValue) =>
        assertEquals(java.lang.Float.floatToRawIntBits(value.paramValue), 4001)
      case other => fail(s"$other")

  test("a returning vehicle flies up, across and down to its home"):
    val back                 = inAir.told(command(20), at(6, Vector3(50, 0, -5), flying = true)).next
    def sets(place: Vector3) = back.steer(at(7, place, flying = true)).setpoint.get
    val up                   = sets(Vector3(50, 0, -5))
    assertEquals((up.vertical, up.third), (VerticalMode.Velocity, -1.5))
    assert(math.abs(up.first) < 0.5, up.toString)
    assert(sets(Vector3(50, 0, -30)).first < -2)
    assertEquals(back.flown(at(9, Vector3(0.1, 0, -30), flying = true)).mode, FlightMode.Land)
