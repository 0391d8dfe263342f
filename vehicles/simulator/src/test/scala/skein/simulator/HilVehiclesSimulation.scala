package skein.simulator

import scala.util.Random
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.hil.*
import skein.link.Address
import skein.mavlink.{FrameReader, HilSensor}
import skein.rpc.RpcRequest
import skein.testing.Unhurried
import skein.units.*

/** External autopilots, without sockets and without a clock. */
class HilVehiclesSimulation extends munit.FunSuite, Unhurried:

  private final class Flown(kind: AutopilotKind = AutopilotKind.Px4, vehicles: Int = 1, speed: Double = 1):
    val simulation = Simulation(
      SimulatorSettings(
        WorldSettings(Vector.tabulate(vehicles)(index =>
          VehicleSettings(s"v$index", Vector3(0, 10 * index, 0))
        )),
        hil = Some(HilSettings(kind, Vector.fill(vehicles)(Address("127.0.0.1", 0)))),
        speed = speed
      ),
      Instant.Epoch
    )
    val hil = HilVehicles(simulation, simulation.settings.hil.get)
    var now = Instant.Epoch

    def up: Span = simulation.world.now.since(Instant.Epoch)

    /** Advances the clock and passes on the resulting datagrams. */
    def run(
        span: Span,
        every: Span = Span.ofMillis(1)
    )(answer: (Long, Array[Byte]) => Seq[Array[Byte]]): Unit =
      val until = now + span
      while now < until do
        now = (now + every).min(until)
        simulation.advance(now)
        var pending = hil.take()
        while pending.nonEmpty do
          for (channel, pieces) <- pending; piece <- pieces; reply <- answer(channel, piece) do
            hil.receive(channel, reply)
            simulation.advance(now)
          pending = hil.take()

    def truth(vehicle: Int = 0) = simulation.world.multirotor(vehicle).state.kinematics

  private def flying(autopilot: SmallAutopilot): (Long, Array[Byte]) => Seq[Array[Byte]] =
    (_, bytes) => Seq(autopilot.hear(bytes)).filter(_.nonEmpty)

  test("a small autopilot with only its sensors arms, takes off and hovers over its start"):
    val flown     = Flown()
    val autopilot = SmallAutopilot()
    flown.hil.join(0, Vector(1), isDatagrams = false)
    flown.hil.receive(0, autopilot.greeting)
    flown.run(Span.ofSeconds(15))(flying(autopilot))
    assert(autopilot.isArmed)
    var worst = 0.0
    flown.run(Span.ofSeconds(10)): (channel, bytes) =>
      val state = flown.truth()
      worst = worst.max((state.positionNed - Vector3(0, 0, -5)).norm)
      flying(autopilot)(channel, bytes)
    assert(worst < 1.5, s"up to $worst m away")
    assertEquals(autopilot.heard.size, 25 * 250)
    assertEquals(autopilot.heard.sliding(2).map(pair => pair(1) - pair(0)).toSet, Set(4000L))
    assertEquals(flown.hil.unanswered, 0L)

  test(
    "time stands still while an autopilot's answer is due, and continues after a second, which is counted"
  ):
    val flown     = Flown()
    val autopilot = SmallAutopilot()
    flown.hil.join(0, Vector(1), isDatagrams = false)
    flown.run(Span.ofSeconds(2))(flying(autopilot))
    val before = flown.up
    flown.run(Span.ofMillis(900))((_, _) => Nil)
    assert((flown.up - before).toMillis <= 4, s"${(flown.up - before).toMillis} ms")
    flown.run(Span.ofMillis(200))((_, _) => Nil)
    assertEquals(flown.hil.unanswered, 1L)
    flown.run(Span.ofSeconds(1))(flying(autopilot))
    // Its delay is skipped except for a few milliseconds.
    assert((flown.up - before).toSeconds < 1.2, s"${(flown.up - before).toSeconds} s")
    assert((flown.simulation.behind + flown.up).toSeconds > 3.9)

  test("a silent autopilot delays the others for a second, and can be waited for again later"):
    val flown  = Flown(vehicles = 2)
    val pilots = Map(0L -> SmallAutopilot(), 1L -> SmallAutopilot(Vector3(0, 0, -3)))
    for (channel, _) <- pilots do flown.hil.join(channel, Vector(channel.toInt + 1), isDatagrams = false)
    def run(span: Span, silent: Long) = flown.run(span)((channel, bytes) =>
      if channel == silent then Nil else flying(pilots(channel))(channel, bytes)
    )
    run(Span.ofSeconds(12), silent = -1)
    val before = flown.up
    run(Span.ofSeconds(6), silent = 1)
    assertEqualsDouble((flown.up - before).toSeconds, 5, 0.1)
    assertEquals(flown.hil.unanswered, 1L)
    assertEqualsDouble(flown.truth(0).positionNed.z, -5, 1)
    run(Span.ofSeconds(2), silent = -1)
    val again = flown.up
    run(Span.ofMillis(500), silent = 1)
    assert((flown.up - again).toMillis <= 4, "in lockstep again")

  test("an autopilot that slows time more than 150-fold is given up, though it answers each time"):
    val flown     = Flown()
    val autopilot = SmallAutopilot()
    flown.hil.join(0, Vector(1), isDatagrams = false)
    flown.run(Span.ofSeconds(1))(flying(autopilot))
    val before   = flown.up
    var underWay = Vector.empty[(Instant, Array[Byte])]
    for _ <- 1 to 10_000 do
      flown.now = flown.now + Span.ofMillis(1)
      flown.simulation.advance(flown.now)
      val (here, later) = underWay.partition(_._1 <= flown.now)
      here.foreach((_, answer) => flown.hil.receive(0, answer))
      underWay = later ++ flown.hil.take().flatMap(_.datagrams).map(bytes =>
        (flown.now + Span.ofMillis(900), autopilot.hear(bytes))
      )
    assertEqualsDouble((flown.up - before).toSeconds, 8.5, 0.8)

  test("an autopilot that repeatedly connects, answers once and falls silent hardly slows time"):
    val flown = Flown()
    var comes = 0L
    for _ <- 1 to 20 do
      val autopilot = SmallAutopilot()
      flown.hil.join(comes, Vector(1), isDatagrams = false)
      var answered = 0
      flown.run(Span.ofSeconds(3)): (channel, bytes) =>
        answered += 1
        if answered <= 5 then flying(autopilot)(channel, bytes) else Nil
      flown.hil.leave(comes)
      comes += 1
    assertEqualsDouble(flown.up.toSeconds, 59, 0.5)

  test("answers after 3 ms slow nothing down, and answers after 6 ms slow the simulator's clock"):
    for (late, seconds) <- Seq(3.0 -> 2.0, 6.0 -> 2.0 * 4 / 6) do
      val flown     = Flown()
      val autopilot = SmallAutopilot()
      flown.hil.join(0, Vector(1), isDatagrams = false)
      flown.run(Span.ofSeconds(1))(flying(autopilot))
      val before   = flown.up
      var underWay = Vector.empty[(Instant, Array[Byte])]
      for _ <- 1 to 2000 do
        flown.now = flown.now + Span.ofMillis(1)
        flown.simulation.advance(flown.now)
        val (here, later) = underWay.partition(_._1 <= flown.now)
        here.foreach((_, answer) => flown.hil.receive(0, answer))
        flown.simulation.advance(flown.now)
        underWay = later ++ flown.hil.take().flatMap(_.datagrams).map(bytes =>
          (flown.now + Span.ofMillis(late), autopilot.hear(bytes))
        )
      assertEqualsDouble((flown.up - before).toSeconds, seconds, 0.03, s"$late ms")

  test("sensors report once that the vehicle was moved, or returned to its start"):
    val flown     = Flown()
    val autopilot = SmallAutopilot()
    val reader    = FrameReader()
    flown.hil.join(0, Vector(1), isDatagrams = false)
    def resets(): Int =
      var count = 0
      flown.run(Span.ofMillis(100)): (channel, bytes) =>
        count += reader.read(bytes).map(_.message).count:
          case sensor: HilSensor => (sensor.fieldsUpdated & 0x80000000L) != 0
          case _                 => false
        flying(autopilot)(channel, bytes)
      count
    assertEquals(resets(), 0)
    val vehicle = flown.simulation.world.multirotor(0)
    vehicle.place(Vector3(0, 0, -10), Quaternion.Identity, flown.simulation.world.now)
    assertEquals(resets(), 1)
    flown.simulation.world.reset()
    assertEquals((resets(), resets()), (1, 0))

  test("a paused simulator sends nothing, and a stepped advance continues sensor by sensor"):
    val flown     = Flown()
    val autopilot = SmallAutopilot()
    flown.hil.join(0, Vector(1), isDatagrams = false)
    flown.run(Span.ofSeconds(2))(flying(autopilot))
    flown.simulation.setPaused(true)
    val (heard, before) = (autopilot.heard.size, flown.up)
    flown.run(Span.ofSeconds(5))(flying(autopilot))
    assertEquals((autopilot.heard.size, flown.up), (heard, before))
    flown.simulation.receive(
      SimulatorCall(1, RpcRequest(0, "simContinueForTime", IndexedSeq(upack.Float64(0.2)), false)),
      flown.now
    )
    assertEquals(flown.simulation.takeAnswers(), Nil)
    flown.run(Span.ofMillis(100))(flying(autopilot))
    assertEquals(flown.simulation.takeAnswers().map(_.token), Seq(1L))
    assertEquals(flown.up - before, Span.ofMillis(200))
    assertEquals(autopilot.heard.size - heard, 50)

  test("two autopilots wait for one another"):
    val flown  = Flown(vehicles = 2)
    val pilots = Map(0L -> SmallAutopilot(), 1L -> SmallAutopilot(Vector3(0, 0, -3)))
    for (channel, _) <- pilots do flown.hil.join(channel, Vector(channel.toInt + 1), isDatagrams = false)
    flown.run(Span.ofSeconds(12))((channel, bytes) => flying(pilots(channel))(channel, bytes))
    assertEqualsDouble(flown.truth(0).positionNed.z, -5, 1)
    assertEqualsDouble(flown.truth(1).positionNed.z, -3, 1)
    val before = flown.up
    flown.run(Span.ofMillis(500))((channel, bytes) =>
      if channel == 1 then Nil else flying(pilots(channel))(channel, bytes)
    )
    assert((flown.up - before).toMillis <= 4)

  test("a vehicle whose autopilot has disconnected is AirSim's again, and falls"):
    val flown     = Flown()
    val autopilot = SmallAutopilot()
    flown.hil.join(0, Vector(1), isDatagrams = false)
    flown.run(Span.ofSeconds(8))(flying(autopilot))
    flown.hil.leave(0)
    flown.run(Span.ofSeconds(10))((_, _) => Nil)
    assertEqualsDouble(flown.truth().positionNed.z, 0, 0.1)

  test("equal seeds give equal flights, to the bit"):
    def flight() =
      val flown     = Flown()
      val autopilot = SmallAutopilot()
      flown.hil.join(0, Vector(1), isDatagrams = false)
      flown.run(Span.ofSeconds(8))(flying(autopilot))
      flown.truth()
    assertEquals(flight(), flight())

  test("ArduPilot sets the pace: a second of frames takes no time by the clock, and its vehicle hovers"):
    val flown      = Flown(AutopilotKind.ArduPilot)
    val controller = SmallController()
    flown.hil.join(0, Vector(1), isDatagrams = true)
    var frame  = 0L
    var pulses = Seq(1000, 1000, 1000, 1000)
    var line   = ""
    for _ <- 1 to 20_000 do
      flown.hil.receive(0, ArduPilotInterfaceSuite.servos(frame, 1000, pulses))
      flown.simulation.advance(flown.now)
      val answers = flown.hil.take().flatMap(_.datagrams)
      assertEquals(answers.size, 1, s"frame $frame")
      line = String(answers.head)
      val told                       = ujson.read(line)
      def vector(value: ujson.Value) = Vector3(value(0).num, value(1).num, value(2).num)
      val turn                       = told("quaternion")
      pulses = controller
        .rotors(
          Vector3(1, 0, -2),
          vector(told("position")),
          vector(told("velocity")),
          Quaternion(turn(0).num, turn(1).num, turn(2).num, turn(3).num),
          vector(told("imu")("gyro")),
          0.001
        )
        .map(control => (1000 + control * 1000).round.toInt)
      frame += 1
    assertEquals(flown.up, Span.ofSeconds(20))
    assert((flown.truth().positionNed - Vector3(1, 0, -2)).norm < 0.2, line)
    flown.run(Span.ofMillis(900))((_, _) => Nil)
    assertEquals(flown.up, Span.ofSeconds(20), "nobody asked for more")
    flown.run(Span.ofSeconds(5))((_, _) => Nil)
    assertEqualsDouble(flown.up.toSeconds, 24.9, 0.2, "time goes on without one that is silent for a second")
    assertEquals(flown.hil.unanswered, 1L)

  test("Betaflight receives the state every 2 ms, by the clock, and missed states are left out"):
    val flown = Flown(AutopilotKind.Betaflight)
    flown.hil.join(0, Vector(1), isDatagrams = true)
    var told = 0
    flown.run(Span.ofSeconds(1)): (_, bytes) =>
      told += 1
      assertEquals(bytes.length, 144)
      Nil
    assertEqualsDouble(told.toDouble, 500, 1)
    told = 0
    flown.run(Span.ofSeconds(1), every = Span.ofMillis(10)): (_, _) =>
      told += 1
      Nil
    assertEqualsDouble(told.toDouble, 100, 1)

  test("damaged and unknown messages of an autopilot do not affect the vehicle or time"):
    for kind <- AutopilotKind.values do
      val random = Random(kind.ordinal)
      val flown  = Flown(kind)
      flown.hil.join(0, Vector(1), isDatagrams = kind != AutopilotKind.Px4)
      for _ <- 1 to 2000 do
        flown.hil.receive(0, random.nextBytes(random.nextInt(300)))
        flown.now = flown.now + Span.ofMillis(1)
        flown.simulation.advance(flown.now)
        flown.hil.take()
      assert(flown.truth().isFinite)
      assertEqualsDouble(flown.truth().positionNed.z, 0, 0.1)
      if kind != AutopilotKind.ArduPilot then assertEqualsDouble(flown.up.toSeconds, 2, 0.01)
