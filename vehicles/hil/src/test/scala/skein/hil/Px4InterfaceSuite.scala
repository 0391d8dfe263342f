package skein.hil

import scala.util.Random
import skein.mavlink.*
import skein.units.*
import skein.vehicle.Setpoint

class Px4InterfaceSuite extends munit.FunSuite:
  import SensorsSuite.atRest

  private final class Peer(from: Span = Span.Zero):
    val interface      = Px4Interface(1, Sensors(1), from)
    private val reader = FrameReader()
    private val writer = FrameWriter(1, 1)

    def say(message: Message): Unit =
      assertEquals(interface.hear(writer.write(message), Span.Zero), Vector.empty)

    def tick(): Vector[Message] =
      val up = interface.stop(Span.Zero)
      sensedUsec = up.toNanos / 1000
      interface.sense(atRest(up, Vector3(3, -4, 1))).flatMap(reader.readDatagram).map(_.message)

    private var sensedUsec = 0L

    def answers(flags: Long = 1): Unit = say(answer(sensedUsec, 1, flags))

    def ticks(seconds: Double): Vector[Message] = Vector.fill((seconds * 250).toInt)(tick()).flatten

  private def controls(mode: Int, flags: Long, values: Float*): Message =
    answer(Long.MaxValue, mode, flags, values*)

  private def answer(toUsec: Long, mode: Int, flags: Long, values: Float*): Message =
    HilActuatorControls(toUsec, values.toVector, mode, flags)

  test("inertial sensors are sent every 4 ms of PX4's time, and magnetometer and barometer every fifth time"):
    val sensors = Peer(Span.ofMillis(7)).ticks(1).collect { case one: HilSensor => one }
    assertEquals(sensors.map(_.timeUsec), Vector.tabulate(250)(tick => 8000L + 4000 * tick))
    assert(sensors.forall(one => (one.fieldsUpdated & 0x3f) == 0x3f))
    assertEquals(sensors.count(one => (one.fieldsUpdated & 0x1c0) == 0x1c0), 50)
    assertEquals(sensors.count(one => (one.fieldsUpdated & 0x1a00) == 0x1a00), 51)
    assertEquals(sensors.count(one => (one.fieldsUpdated & ~0x1fffL) != 0), 0)
    assertEqualsFloat(sensors.last.absPressure, 998.63f, 0.5f)
    assertEqualsFloat(sensors.last.pressureAlt, 122f, 5f)

  test("satellite fixes are sent eight times per second from the first second on, and are 110 ms old"):
    val gps = Peer().ticks(3).collect { case one: HilGps => one }
    assertEquals(gps.size, 16)
    assertEquals((gps.head.fixType, gps.head.vel, gps.head.satellitesVisible), (3, gps.head.vel, 10))
    assertEqualsDouble(gps.head.lat * 1e-7, 47.641468, 1e-5)
    assertEqualsDouble(gps.head.vel.toDouble, 500, 20)
    assertEqualsDouble(gps.head.cog.toDouble, 30687, 400)
    assertEquals(gps.head.timeUsec, 1_001_000_000L)

  test("the true state is sent as often as requested, and never without a request"):
    val peer               = Peer()
    def states(s: Double)  = peer.ticks(s).collect { case one: HilStateQuaternion => one }
    def ask(micros: Float) = peer.say(CommandLong(0, 0, 511, 0, 115, micros, 0, 0, 0, 0, 0))
    assertEquals(states(1).size, 0)
    ask(20_000)
    assertEquals(states(1).size, 50)
    for bad <- Seq(Float.NaN, Float.PositiveInfinity, 3e38f) do ask(bad)
    ask(1)
    assertEqualsDouble(states(1).size.toDouble, 250, 1)
    ask(-1)
    assertEquals(states(1).size, 0)

  test(
    "physics waits for no answer before the first, then for each, until answers state the end of lockstep"
  ):
    val peer = Peer()
    peer.ticks(2)
    assert(!peer.interface.isWaiting)
    peer.answers()
    assert(!peer.interface.isWaiting)
    peer.tick()
    assert(peer.interface.isWaiting)
    peer.say(Heartbeat(0, 12, 0, 0, 0, 3))
    assert(peer.interface.isWaiting)
    peer.answers()
    assert(!peer.interface.isWaiting)
    peer.tick()
    peer.interface.giveUp()
    assert(!peer.interface.isWaiting)
    peer.answers(flags = 0)
    peer.tick()
    assert(!peer.interface.isWaiting)

  test("physics waits for the answer to the newest sensors, not for earlier answers"):
    val peer   = Peer()
    val sensed = peer.ticks(1).collect { case one: HilSensor => one.timeUsec }
    for (at, count) <- sensed.init.zipWithIndex do
      peer.say(answer(at, 1, 1))
      assert(peer.interface.isWaiting, s"answered at $at")
      if count % 30 == 0 then
        peer.interface.giveUp()
        assert(peer.interface.isWaiting, s"it catches up, at $at")
    peer.say(answer(sensed.last, 1, 1))
    assert(!peer.interface.isWaiting)

  test("a PX4 that answers with other times is waited for once, and then time continues without it"):
    val peer = Peer()
    peer.ticks(1)
    peer.say(answer(7, 1, 1))
    peer.interface.giveUp()
    assert(peer.interface.isWaiting, "it may catch up")
    peer.interface.giveUp()
    for time <- 8 to 1000 do
      assert(!peer.interface.isWaiting)
      peer.tick()
      peer.say(answer(time, 1, 1))

  test("a PX4 that answers once and then never is not waited for again"):
    val peer = Peer()
    peer.ticks(1)
    peer.say(controls(1, 1))
    peer.tick()
    assert(peer.interface.isWaiting)
    peer.interface.giveUp()
    for tick <- 1 to 1000 do
      peer.tick()
      assert(!peer.interface.isWaiting, s"tick $tick")
    assertEquals(peer.interface.losses, 1)

  test("a PX4 that was given up is waited for again after a second of answers in time, then after two"):
    val peer = Peer()
    peer.say(controls(1, 1))
    for (seconds, loss) <- Seq(1, 2, 4).zipWithIndex do
      peer.tick()
      peer.interface.giveUp()
      assertEquals(peer.interface.losses, loss + 1)
      var answers = 0
      while !peer.interface.isWaiting do
        val sensed = peer.tick().collect { case one: HilSensor => one.timeUsec }.head
        if !peer.interface.isWaiting then
          peer.say(answer(sensed, 1, 1))
          // A second answer to these sensors does not count.
          peer.say(answer(sensed, 1, 1))
          answers += 1
      assertEquals(answers, 250 * seconds)

  test("a PX4 that answers rarely is not waited for, also after it reconnects"):
    val peer = Peer()
    peer.say(controls(1, 1))
    peer.tick()
    peer.interface.giveUp()
    for _ <- 1 to 1000 do
      peer.ticks(0.12)
      peer.answers()
    peer.tick()
    assert(!peer.interface.isWaiting)
    val again = Px4Interface(1, Sensors(1), Span.Zero, before = peer.interface.losses)
    again.hear(FrameWriter(1, 1).write(controls(1, 1)), Span.Zero): Unit
    again.sense(atRest(again.stop(Span.Zero), Vector3.Zero)): Unit
    assert(!again.isWaiting)

  for (name, absurd) <- Seq("0" -> 0L, "2^63 - 1" -> Long.MaxValue) do
    test(s"answers with times of $name delay physics at most once, and then silence ends the waiting"):
      val peer = Peer()
      peer.ticks(1)
      var waits = 0
      for _ <- 1 to 1000 do
        peer.say(answer(absurd, 1, 1))
        peer.say(answer(absurd, 1, 1))
        if peer.interface.isWaiting then
          waits += 1
          peer.interface.giveUp()
        peer.tick()
      assert(waits <= 1, s"$waits waits")
      peer.interface.giveUp()
      peer.tick()
      assert(!peer.interface.isWaiting)

  test("rotors turn only while PX4 is armed, each between 0 and 1, and stop for NaN"):
    val peer = Peer()
    peer.say(controls(1, 1, 0.5f, 0.5f, 0.5f, 0.5f))
    assertEquals(peer.interface.rotors, AutopilotInterface.MotorsOff)
    peer.say(controls(129, 1, 0.25f, Float.NaN, 7f, -1f))
    assertEquals(peer.interface.rotors, Setpoint.rotors(0.25, 0, 1, 0))

  test("a thousand damaged frames of each kind, and a thousand with any content, do no harm"):
    val random = Random(560)
    val peer   = Peer()
    val writer = FrameWriter(3, 3)
    for definition <- Dialect.all; _ <- 1 to 1000 do
      val frame = writer.write(definition.decode(random.nextBytes(definition.length)))
      peer.interface.hear(frame, Span.Zero)
      frame(random.nextInt(frame.length)) = random.nextInt(256).toByte
      peer.interface.hear(frame.take(1 + random.nextInt(frame.length)), Span.Zero)
    assert(peer.interface.damaged > 1000)
    // Enough bytes to end any damaged frame, whatever its stated length.
    for _ <- 1 to 40 do peer.say(controls(129, 1, 0.5f, 0.5f, 0.5f, 0.5f))
    assertEquals(peer.interface.rotors, Setpoint.rotors(0.5, 0.5, 0.5, 0.5))
    assert(peer.ticks(1).nonEmpty)
