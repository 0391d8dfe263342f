package skein.hil

import java.nio.{ByteBuffer, ByteOrder}
import scala.util.Random
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.Setpoint

class BetaflightInterfaceSuite extends munit.FunSuite:
  import SensorsSuite.{atRest, home}

  private def interface = BetaflightInterface(Sensors(1, SensorNoise.None), Span.ofMillis(3.7))

  private def servos(controls: Float*): Array[Byte] =
    val packet = ByteBuffer.allocate(16).order(ByteOrder.LITTLE_ENDIAN)
    controls.foreach(packet.putFloat)
    packet.array

  test("the state is due every 2 ms, and missed states are left out"):
    val one = interface
    assertEquals(one.stop(Span.Zero), Span.ofMillis(5))
    assertEquals(one.stop(Span.ofMillis(20.4)), Span.ofMillis(20))
    one.sense(atRest(Span.ofMillis(20)))
    assertEquals(one.stop(Span.ofMillis(20.4)), Span.ofMillis(22))
    assert(!one.isWaiting && one.isByClock)

  test("the state is sent in Betaflight's frames"):
    val truth = atRest(Span.ofMillis(5)).copy(
      kinematics = Kinematics(
        Vector3(1, 2, -3),
        Vector3(4, 5, -6),
        Quaternion(0.5, 0.5, -0.5, 0.5),
        Vector3(0.1, 0.2, 0.3)
      ),
      accelerationNed = Vector3(0, 0, 9.80665)
    )
    val packet = ByteBuffer.wrap(interface.sense(truth).head).order(ByteOrder.LITTLE_ENDIAN)
    val told   = Vector.fill(18)(packet.getDouble)
    assertEquals(told.take(4), Vector(0.0, 0.1, 0.2, 0.3))
    assertEquals(told.slice(4, 7).map(_.abs), Vector(0.0, 0.0, 0.0), "nothing pulls at what falls")
    assertEquals(told.slice(7, 11), Vector(0.5, 0.5, -0.5, 0.5))
    assertEquals(told.slice(11, 14), Vector(5.0, 4.0, 6.0), "east, north, up")
    assertEquals(told.slice(14, 17), Vector(home.longitudeDeg, home.latitudeDeg, 122.0))
    assertEquals(told.last, truth.pressurePa)
    val resting =
      ByteBuffer.wrap(interface.sense(atRest(Span.ofMillis(5))).head).order(ByteOrder.LITTLE_ENDIAN)
    assertEquals(resting.getDouble(6 * 8), -9.80665)

  test("Betaflight reads the true attitude: roll to the right, nose down, heading clockwise"):
    val random = Random(11)
    for _ <- 1 to 200 do
      def one()  = random.nextGaussian()
      val turn   = Quaternion(one(), one(), one(), one()).normalized
      val truth  = atRest(Span.ofMillis(5))
      val packet = interface.sense(truth.copy(kinematics = truth.kinematics.copy(orientation = turn))).head
      val told   = ByteBuffer.wrap(packet).order(ByteOrder.LITTLE_ENDIAN)
      val (w, x) = (told.getDouble(7 * 8), told.getDouble(8 * 8))
      val (y, z) = (told.getDouble(9 * 8), told.getDouble(10 * 8))
      // The formulas of imuComputeRotationMatrix and imuUpdateEulerAngles for a simulated attitude.
      val (m00, m10) = (1 - 2 * (y * y + z * z), -2 * (x * y + w * z))
      val m20        = -2 * (x * z - w * y)
      val (m21, m22) = (2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
      assertEqualsDouble(math.atan2(m21, m22), turn.rollRad, 1e-9)
      assertEqualsDouble(math.Pi / 2 - math.acos(-m20), -turn.pitchRad, 1e-7)
      assertEqualsDouble(-math.atan2(m10, m00), turn.yawRad, 1e-9)

  /** The due states up to a time with their send times, for a vehicle at rest. */
  private def states(one: BetaflightInterface, from: Int, until: Int): Vector[(upMs: Long, toldMs: Long)] =
    Iterator
      .iterate(one.stop(Span.ofMillis(from)))(up => one.stop(up + Span.ofMillis(1)))
      .takeWhile(_ <= Span.ofMillis(until))
      .map: up =>
        val packet = ByteBuffer.wrap(one.sense(atRest(up)).head).order(ByteOrder.LITTLE_ENDIAN)
        (upMs = up.toNanos / 1_000_000, toldMs = (packet.getDouble * 1000).round)
      .toVector

  test("at the real clock's speed the sent time is constant, so that Betaflight keeps the real clock"):
    val one = BetaflightInterface(Sensors(1, SensorNoise.None), Span.Zero)
    one.hear(servos(0, 0, 0, 0), Span.ofMillis(3))
    assertEquals(states(one, 4, 100).map(_.toldMs).distinct, Vector(0L))

  test("at another speed, two states convey the clock's rate each time that Betaflight starts to send"):
    val one   = BetaflightInterface(Sensors(1, SensorNoise.None), Span.Zero, 0.5)
    val heard = servos(0, 0, 0, 0)
    assertEquals(states(one, 1, 50).map(_.toldMs).distinct, Vector(0L), "it may not be there")
    one.hear(heard, Span.ofMillis(51))
    val first = states(one, 52, 100)
    assertEquals(first.take(3), Vector((52L, 0L), (67L, 15L), (69L, 15L)))
    assertEquals(first.map(_.toldMs).distinct, Vector(0L, 15L))
    for up <- 100 to 400 by 2 do one.hear(heard, Span.ofMillis(up))
    assertEquals(states(one, 401, 500).map(_.toldMs).distinct, Vector(15L))
    one.hear(heard, Span.ofMillis(540))
    assertEquals(states(one, 541, 600).map(_.toldMs).distinct, Vector(15L, 30L))

  test("if two states are too far apart to convey the rate, the next two convey it"):
    val one = BetaflightInterface(Sensors(1, SensorNoise.None), Span.Zero, 0.5)
    one.hear(servos(0, 0, 0, 0), Span.ofMillis(3))
    assertEquals(states(one, 4, 4).map(_.toldMs), Vector(0L))
    assertEquals(states(one, 30, 50), Vector((30L, 0L), (45L, 15L), (47L, 15L), (49L, 15L)))

  test("controls are applied as received, clamped to 0 to 1; datagrams of another length are counted"):
    val one = interface
    one.hear(servos(0.5f, Float.NaN, 2, -1), Span.Zero)
    assertEquals(one.rotors, Setpoint.rotors(0.5, 0, 1, 0))
    val random = Random(3)
    for length <- 0 to 200 if length != 16 do one.hear(random.nextBytes(length), Span.Zero)
    assertEquals((one.damaged, one.rotors), (200L, Setpoint.rotors(0.5, 0, 1, 0)))
