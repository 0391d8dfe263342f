package skein.observe

import org.apache.pekko.util.ByteString
import skein.mavlink.*
import skein.units.*

/** Times are in milliseconds, on the observer's clock; a vehicle's clock since boot is behind it. */
class MavlinkLoopSuite extends munit.FunSuite:
  private val bootAtMs = 86_400_000L

  private final class Conversation(readings: Set[String] = Set.empty, isDatagrams: Boolean = true):
    val loop            = MavlinkLoop(isDatagrams, readings)
    private val writers = (1 to 255).map(FrameWriter(_, 1))
    loop.opened(0, at(0))

    private def at(ms: Double) = Instant.ofNanos(((bootAtMs + ms) * 1e6).round)

    def send(system: Int, ms: Double)(message: Message): Unit = pass(bytes(system, message), system > 200, ms)

    /** A message that the program sends by the vehicle's own number. */
    def asVehicle(component: Int, ms: Double)(message: Message): Unit =
      pass(FrameWriter(1, component).write(message), true, ms)

    def bytes(system: Int, message: Message): Array[Byte] = writers(system - 1).write(message)

    def pass(bytes: Array[Byte], isFromClient: Boolean, ms: Double): Unit =
      loop.passed(0, isFromClient, ByteString.fromArray(bytes), at(ms))

    def position(system: Int, sampledMs: Long, passedMs: Double): Unit =
      send(system, passedMs)(LocalPositionNed(sampledMs, 0, 0, 0, 0, 0, 0))

    def setpoint(target: Int, ms: Double): Unit =
      send(255, ms)(SetPositionTargetLocalNed(0, target, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0))

    /** A TIMESYNC of system 1, whose answer is made halfway. */
    def timesync(sentMs: Double, receivedMs: Double): Unit =
      val ours = (sentMs * 1e6).round
      send(255, sentMs)(Timesync(0, ours))
      send(1, receivedMs)(Timesync(((sentMs + receivedMs) / 2 * 1e6).round, ours))

    def ages: Vector[Option[Double]] = loop.observed.log.map(_.ownAgeMs.map(_.round.toDouble))

  test("with TIMESYNC, ages count from when a position was sampled, within the round trip's bound"):
    val here = Conversation()
    here.position(1, 0, 60)
    here.timesync(100, 140)
    here.position(1, 150, 190)
    here.setpoint(1, 200)
    assertEquals(here.ages, Vector(Some(50.0)))
    val bound = here.loop.observed.log.head.boundMs.get
    assert(bound > 0 && bound <= 20.1, bound)
    assertEquals(here.loop.observed.byOtherClock, Vector.empty)

  test("ages from before the first TIMESYNC are left out and counted"):
    val here = Conversation()
    here.position(1, 0, 60)
    here.setpoint(1, 100)
    assertEquals(here.loop.observed.vehicles.head.ownAgeMs.map(_.count), Some(1))
    here.timesync(110, 140)
    here.position(1, 150, 190)
    here.setpoint(1, 200)
    here.setpoint(1, 210)
    val vehicle = here.loop.observed.vehicles.head
    assertEquals((vehicle.commands, vehicle.early), (3L, 1L))
    assertEquals(vehicle.ownAgeMs.map(_.sorted.map(_.round.toInt).toVector), Some(Vector(50, 60)))

  test("without TIMESYNC, ages lack the fastest message's latency, and a remark states that"):
    val here = Conversation()
    here.position(1, 0, 60)
    here.position(1, 50, 80)
    here.setpoint(1, 100)
    assertEquals(here.ages, Vector(Some(20.0)))
    assertEquals(here.loop.observed.byOtherClock, Vector("system 1"))
    assertEquals(here.loop.observed.log.head.boundMs, None)

  test("an answer to a TIMESYNC that did not pass changes nothing"):
    val here = Conversation()
    here.position(1, 0, 30)
    here.send(1, 40)(Timesync(1, 77))
    here.setpoint(1, 50)
    assertEquals(here.loop.observed.byOtherClock, Vector("system 1"))

  test("a program's messages under the vehicle's number are neither its readings nor its clock"):
    for component <- Seq(1, 191) do
      val here = Conversation()
      here.position(1, 0, 10)
      here.setpoint(1, 20)
      here.send(1, 30)(Timesync(0, 5))
      here.asVehicle(component, 31)(Timesync(777, 5))
      here.asVehicle(component, 40)(LocalPositionNed(3_000_000, 0, 0, 0, 0, 0, 0))
      here.setpoint(1, 60)
      assertEquals(here.ages, Vector(Some(10.0), Some(50.0)), s"component $component")
      assertEquals(here.loop.observed.byOtherClock, Vector("system 1"))

  test("a restarted vehicle is read by its new clock"):
    val here = Conversation()
    here.position(1, 600_000, 600_010)
    here.timesync(600_020, 600_030)
    // It counts from 0 again.
    for ms <- 700_000 to 700_100 by 50 do here.position(1, ms - 699_990, ms.toDouble)
    here.setpoint(1, 700_120)
    assertEquals(here.ages, Vector(Some(20.0)))

  test("if no vehicle was heard, a remark states that"):
    val here = Conversation()
    here.setpoint(1, 10)
    assert(here.loop.remarks.exists(_.startsWith("No vehicle was heard")), here.loop.remarks)

  test("a setpoint to system 0 is a command to every vehicle, each with its own data"):
    val here = Conversation()
    here.position(1, 0, 10)
    here.position(2, 20, 30)
    here.setpoint(0, 50)
    assertEquals(here.loop.observed.log.map(_.vehicle), Vector("system 1", "system 2"))
    assertEquals(here.loop.observed.log.map(_.othersAgeMs.map(_.round)), Vector(Some(20L), Some(40L)))

  test("only the chosen messages count as readings"):
    val here = Conversation(readings = Set("ATTITUDE"))
    here.position(1, 0, 10)
    here.send(1, 20)(Attitude(10, 0, 0, 0, 0, 0, 0))
    here.setpoint(1, 30)
    assertEquals(
      here.loop.observed.topics.map(_.name),
      Vector("ATTITUDE of 1", "SET_POSITION_TARGET_LOCAL_NED to 1")
    )
    assertEquals(here.ages, Vector(Some(10.0)))

  test("a stream may be cut anywhere, and damage is counted and passed over"):
    val here  = Conversation(isDatagrams = false)
    val frame = here.bytes(1, LocalPositionNed(0, 0, 0, 0, 0, 0, 0))
    here.pass(frame.take(7), false, 5)
    here.pass(frame.drop(7), false, 10)
    val damaged = here.bytes(1, LocalPositionNed(50, 0, 0, 0, 0, 0, 0)).updated(12, 99.toByte)
    here.pass(damaged, false, 20)
    here.position(1, 100, 110)
    here.setpoint(1, 120)
    assertEquals(here.loop.observed.topics.head.messages, 2L)
    assertEquals(here.ages, Vector(Some(10.0)))
    assert(here.loop.remarks.exists(_.contains("damaged")), here.loop.remarks)

  test("a datagram that was cut does not join the next one"):
    val here = Conversation()
    here.pass(here.bytes(1, LocalPositionNed(0, 0, 0, 0, 0, 0, 0)).take(9), false, 5)
    here.position(1, 0, 10)
    assertEquals(here.loop.observed.topics.map(_.messages), Vector(1L))

  test("connections beyond the limit are counted"):
    val here = Conversation()
    for connection <- 1 to MavlinkLoop.MostConnections do here.loop.opened(connection, Instant.Epoch)
    val frame = ByteString.fromArray(here.bytes(1, LocalPositionNed(0, 0, 0, 0, 0, 0, 0)))
    here.loop.passed(MavlinkLoop.MostConnections, false, frame, Instant.Epoch)
    assertEquals(here.loop.observed.notKept, 1L)
