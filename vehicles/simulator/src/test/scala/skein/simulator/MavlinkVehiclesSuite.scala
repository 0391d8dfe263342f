package skein.simulator

import scala.util.Random
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.mavlink.*
import skein.units.*

/** The simulator's vehicles by MAVLink, without sockets and without a clock. */
class MavlinkVehiclesSuite extends munit.FunSuite:
  private final class Flown(vehicles: Int = 1, isDatagrams: Boolean = false, firstSystem: Int = 1):
    val simulation = Simulation(
      SimulatorSettings(WorldSettings(Vector.tabulate(vehicles)(index =>
        VehicleSettings(s"v$index", Vector3(0, 10 * index, 0))
      ))),
      Instant.Epoch
    )
    private val mavlink = MavlinkVehicles(simulation, MavlinkSettings(firstSystem = firstSystem))
    private val reader  = FrameReader()
    private val writer  = FrameWriter(245, 190)
    var heard           = Vector.empty[Frame]
    var now             = Instant.Epoch
    mavlink.join(0, Vector.empty, isDatagrams)

    def send(message: Message): Unit = send(writer.write(message))

    def send(bytes: Array[Byte]): Unit =
      mavlink.receive(0, bytes)
      take()

    def run(span: Span): Unit =
      val until = now + span
      while now < until do
        now = (now + Span.ofMillis(20)).min(until)
        simulation.advance(now)
        take()

    private def take(): Unit =
      for (_, datagrams) <- mavlink.take(); bytes <- datagrams do
        assert(bytes.length <= 1400, s"${bytes.length} bytes")
        heard ++= reader.readDatagram(bytes)

    def last[A](using tag: reflect.ClassTag[A]): A =
      heard.reverseIterator.map(_.message).collectFirst { case one: A => one }.get

  private def command(system: Int, number: Int, numbers: Float*): Message =
    val all = numbers.padTo(7, 0f)
    CommandLong(system, 1, number, 0, all(0), all(1), all(2), all(3), all(4), all(5), all(6))

  private def takenOff(vehicles: Int = 1): Flown =
    val flown = Flown(vehicles)
    for system <- 1 to vehicles do
      flown.send(command(system, 400, 1))
      flown.send(command(system, 22, 0, 0, 0, 0, 0, 0, Float.NaN))
    flown.run(Span.ofSeconds(8))
    flown

  test("the vehicles of a second simulator have their own ports and numbers, as PX4's instances do"):
    assertEquals(
      MavlinkSettings.asPx4(2, instance = 3).udp.map(port =>
        (port.at.port, port.tells.map(_.port), port.systems)
      ),
      Vector(
        (18573, Some(14550), Vector.empty),
        (14583, Some(14543), Vector(4)),
        (14584, Some(14544), Vector(5))
      )
    )
    val flown = Flown(vehicles = 2, firstSystem = MavlinkSettings.asPx4(2, instance = 3).firstSystem)
    flown.send(command(5, 400, 1))
    flown.run(Span.ofSeconds(2))
    val armed = flown.heard.collect { case Frame(system, _, _, Heartbeat(_, _, base, _, _, _), _) =>
      system -> ((base & 128) != 0)
    }
    assertEquals(armed.map(_._1).toSet, Set(4, 5))
    assertEquals(armed.groupMapReduce(_._1)(_._2)(_ || _), Map(4 -> false, 5 -> true))

  test("a truncated datagram does not delay later ones"):
    val flown = Flown(isDatagrams = true)
    flown.send(Array(0xfd, 0xff, 0, 0, 0, 0xff, 0xbe, 0x4c, 0, 0, 1, 2, 3).map(_.toByte))
    flown.send(command(1, 400, 1))
    assertEquals(flown.last[CommandAck].result, 0)

  test("impossible setpoints are refused with a text, and do not move the vehicle"):
    val flown = takenOff()
    for (order, result) <- Seq(
        command(1, 511, 32, Float.NaN)                                    -> 2,
        command(1, 511, 32, Float.PositiveInfinity)                       -> 2,
        command(1, 192, -1, 0, 0, 3e38f, Float.NaN, Float.NaN, Float.NaN) -> 2,
        command(1, 192, -1, 0, 0, Float.NaN, 3e38f, Float.NaN, Float.NaN) -> 2,
        command(1, 192, -1, 0, 0, Float.NaN, Float.NaN, Float.NaN, 3e38f) -> 2,
        command(1, 22, 0, 0, 0, 0, 0, 0, 3e38f)                           -> 2
      )
    do
      flown.send(order)
      assertEquals(flown.last[CommandAck].result, result, order.toString)
    flown.send(SetAttitudeTarget(0, 1, 1, 128, Vector(1, 0, 0, 0), 3e38f, 0, 0, 0.5f))
    assert(clue(flown.last[Statustext].text).contains("attitude"))
    val before = flown.last[LocalPositionNed]
    flown.run(Span.ofSeconds(3))
    assertEqualsFloat(flown.last[LocalPositionNed].z, before.z, 0.3f)

  test("a vehicle arms, takes off, flies a velocity, returns, lands and disarms; telemetry shows all of it"):
    val flown = takenOff()
    assertEqualsFloat(flown.last[LocalPositionNed].z, -2.5f, 0.35f)
    def fly() = flown.send(SetPositionTargetLocalNed(0, 1, 1, 1, 0xdc7, 0, 0, 0, 3, 0, -1, 0, 0, 0, 0, 0))
    fly()
    flown.send(command(1, 176, 1, 6, 0))
    for _ <- 1 to 50 do
      fly()
      flown.run(Span.ofMillis(100))
    val flying = flown.last[LocalPositionNed]
    assertEqualsFloat(flying.vx, 3, 0.1f)
    assertEqualsFloat(flying.vz, -1, 0.1f)
    val odometry = flown.last[Odometry]
    val turn     = Quaternion(odometry.q(0), odometry.q(1), odometry.q(2), odometry.q(3))
    val inWorld  = turn.toWorld(Vector3(odometry.vx, odometry.vy, odometry.vz))
    assert((inWorld - Vector3(flying.vx, flying.vy, flying.vz)).norm < 1e-3, inWorld.toString)
    flown.run(Span.ofSeconds(2))
    assertEquals(flown.last[Heartbeat].customMode, 4L << 16 | 3L << 24)
    flown.send(command(1, 20))
    flown.run(Span.ofSeconds(90))
    val landed = flown.last[LocalPositionNed]
    assert(StrictMath.hypot(landed.x, landed.y) < 1 && landed.z.abs < 0.3, landed.toString)
    assertEquals(flown.last[ExtendedSysState].landedState, 1)
    assertEquals(flown.last[Heartbeat].baseMode & 128, 0)

  test("each vehicle receives its own messages, and all receive broadcasts"):
    val flown = Flown(vehicles = 3)
    flown.send(command(2, 400, 1))
    flown.run(Span.ofSeconds(1.1))
    val armed = (1 to 3).map(system =>
      flown.heard.filter(_.system == system).map(_.message).collect { case h: Heartbeat =>
        h
      }.last.baseMode & 128
    )
    assertEquals(armed, Vector(0, 128, 0))
    flown.send(Timesync(0, 5))
    assertEquals(
      flown.heard.collect { case Frame(system, _, _, Timesync(_, 5, _, _), _) => system },
      Vector(1, 2, 3)
    )

  test("messages are sent as often as requested"):
    val flown = Flown()
    flown.send(command(1, 511, 32, 20_000))
    flown.send(command(1, 511, 30, -1))
    flown.heard = Vector.empty
    flown.run(Span.ofSeconds(2))
    val messages = flown.heard.map(_.message)
    assertEquals(messages.count(_.isInstanceOf[LocalPositionNed]), 100)
    assertEquals(messages.count(_.isInstanceOf[Attitude]), 0)
    assertEquals(messages.count(_.isInstanceOf[Heartbeat]), 2)

  test("without MAVLink's arming, AirSim's own calls fly the vehicle"):
    val flown = Flown()
    flown.run(Span.ofSeconds(1))
    assert(!flown.simulation.world.vehicles.head.apiControl)

  test("a thousand damaged frames of each kind, and a thousand whole ones of any content, do no harm"):
    val random = Random(18)
    val flown  = takenOff()
    val writer = FrameWriter(245, 190)
    for definition <- Dialect.all; round <- 1 to 1000 do
      val bytes   = random.nextBytes(definition.length)
      val message = definition.decode(bytes)
      val frame   = writer.write(message)
      flown.send(frame)
      frame(random.nextInt(frame.length)) = random.nextInt(256).toByte
      flown.send(frame.take(1 + random.nextInt(frame.length)))
      if round % 100 == 0 then
        flown.heard = Vector.empty
        flown.run(Span.ofMillis(20))
    flown.run(Span.ofSeconds(60))
    flown.heard = Vector.empty
    for _ <- 1 to 40 do flown.send(Timesync(0, 99)) // enough to end any damaged frame
    assert(flown.heard.exists(_.message match
      case Timesync(_, 99, _, _) => true
      case _                     => false))
    assert(flown.simulation.world.multirotor(0).state.kinematics.isFinite)

  for extreme <- Seq(Float.NaN, Float.PositiveInfinity, Float.NegativeInfinity, Float.MaxValue, -1e9f) do
    test(s"commands whose numbers are all $extreme keep the vehicle's state finite"):
      val flown = takenOff()
      for number <- (0 to 600).toVector :+ 2500 do
        flown.send(command(1, number, Seq.fill(7)(extreme)*))
        flown.send(command(1, number, 1 +: Seq.fill(6)(extreme)*))
        flown.heard = Vector.empty
        if number % 10 == 0 then flown.run(Span.ofMillis(20))
      flown.run(Span.ofSeconds(5))
      assert(flown.simulation.world.multirotor(0).state.kinematics.isFinite)

  test("a peer that requests all parameters a thousand times is sent no more than it can take"):
    val flown = Flown(vehicles = 5)
    val frame = FrameWriter(245, 190).write(ParamRequestList(0, 1))
    flown.send(Array.fill(1000)(frame).flatten)
    val answers = flown.heard.count(_.message.isInstanceOf[ParamValue])
    assert(answers > 100 && answers < 5000, s"$answers answers")
