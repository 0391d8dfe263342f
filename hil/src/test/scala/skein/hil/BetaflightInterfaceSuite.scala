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

  test("the state is due every 2 ms; what is late is left out"):
    val one = interface
    assertEquals(one.stop(Span.Zero), Span.ofMillis(5))
    assertEquals(one.stop(Span.ofMillis(20.4)), Span.ofMillis(20))
    one.sense(atRest(Span.ofMillis(20)))
    assertEquals(one.stop(Span.ofMillis(20.4)), Span.ofMillis(22))
    assert(!one.isWaiting && one.isByClock)

  test("the state is told in Betaflight's frames"):
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
    assertEquals(told.slice(7, 11), Vector(0.5, 0.5, 0.5, -0.5))
    assertEquals(told.slice(11, 14), Vector(5.0, 4.0, 6.0), "east, north, up")
    assertEquals(told.slice(14, 17), Vector(home.longitudeDeg, home.latitudeDeg, 122.0))
    assertEquals(told.last, truth.pressurePa)
    val resting =
      ByteBuffer.wrap(interface.sense(atRest(Span.ofMillis(5))).head).order(ByteOrder.LITTLE_ENDIAN)
    assertEquals(resting.getDouble(6 * 8), -9.80665)

  test(
    "at the real clock's speed Betaflight's time stands still, so that it keeps the real clock; else it passes"
  ):
    def milliseconds(speed: Double) =
      val one = BetaflightInterface(Sensors(1, SensorNoise.None), Span.Zero, speed)
      Vector(5, 9).map: up =>
        val packet = ByteBuffer.wrap(one.sense(atRest(Span.ofMillis(up))).head)
        (packet.order(ByteOrder.LITTLE_ENDIAN).getDouble * 1000).round
    assertEquals((milliseconds(1), milliseconds(2)), (Vector(0L, 0L), Vector(5L, 9L)))

  test("controls are taken as they come, between 0 and 1; of any other length they are counted"):
    val one = interface
    one.hear(servos(0.5f, Float.NaN, 2, -1), Span.Zero)
    assertEquals(one.rotors, Setpoint.rotors(0.5, 0, 1, 0))
    val random = Random(3)
    for length <- 0 to 200 if length != 16 do one.hear(random.nextBytes(length), Span.Zero)
    assertEquals((one.damaged, one.rotors), (200L, Setpoint.rotors(0.5, 0, 1, 0)))
