package skein.hil

import java.nio.charset.StandardCharsets.US_ASCII
import java.nio.{ByteBuffer, ByteOrder}
import scala.util.Random
import skein.units.*
import skein.vehicle.Setpoint

object ArduPilotInterfaceSuite:
  /** A datagram with servo pulses, encoded as by ArduPilot. */
  def servos(frame: Long, rate: Int, pulses: Seq[Int], magic: Int = 18458, count: Int = 16): Array[Byte] =
    val packet = ByteBuffer.allocate(8 + 2 * count).order(ByteOrder.LITTLE_ENDIAN)
    packet.putShort(magic.toShort).putShort(rate.toShort).putInt(frame.toInt)
    pulses.foreach(pulse => packet.putShort(pulse.toShort))
    packet.array

class ArduPilotInterfaceSuite extends munit.FunSuite:
  import ArduPilotInterfaceSuite.servos
  import SensorsSuite.atRest

  private def interface = ArduPilotInterface(Sensors(1, SensorNoise.None), Span.Zero)

  private val hover = Seq(1500, 1250, 2300, 900)

  test("physics waits for the servos, advances by a frame of whole milliseconds, and answers in one line"):
    for (rate, millis) <- Seq(1200 -> 1, 400 -> 3, 250 -> 4, 50 -> 20, 1 -> 20, 0 -> 20, 65535 -> 1) do
      val one = interface
      assert(one.isWaiting)
      assertEquals(one.hear(servos(0, rate, hover), Span.ofMillis(7.5)), Vector.empty)
      assert(!one.isWaiting)
      assertEquals(one.rotors, Setpoint.rotors(0.5, 0.25, 1, 0))
      assertEquals(one.stop(Span.Zero), Span.ofMillis(7.0 + millis), s"$rate Hz")
    val one = interface
    one.hear(servos(0, 1000, hover), Span.Zero)
    val line = one.sense(atRest(Span.ofMillis(1), Vector3(3, -4, 0.5))).map(String(_, US_ASCII))
    assertEquals(line.size, 1)
    assert(line.head.startsWith("\n{") && line.head.endsWith("}\n"), line.head)
    val told = line.head
    assert(told.contains(""""timestamp":0.001,"""), told)
    assert(told.contains(""""imu":{"gyro":[0.0,0.0,0.0],"accel_body":[0.0,0.0,-9.80665]}"""), told)
    assert(told.contains(""""velocity":[3.0,-4.0,0.5]"""), told)
    assert(told.contains(""""attitude":[0.0,0.0,0.0]"""), told)
    assert(one.isWaiting)

  test("a repeated frame gets its first answer again, and physics does not advance"):
    val one = interface
    one.hear(servos(4, 1000, hover), Span.Zero)
    val answer = one.sense(atRest(Span.ofMillis(1)))
    assertEquals(one.hear(servos(4, 1000, hover), Span.ofMillis(1)).map(_.toSeq), answer.map(_.toSeq))
    assert(one.isWaiting)
    one.hear(servos(0, 1000, hover), Span.ofMillis(1))
    assert(!one.isWaiting, "ArduPilot has started again")

  test("packets of 32 servos are read, and invalid packets are counted and move nothing"):
    val one = interface
    one.hear(servos(0, 1000, hover, magic = 29569, count = 32), Span.Zero)
    assert(!one.isWaiting)
    val random = Random(9)
    val other  = interface
    val whole  = servos(0, 1000, hover)
    for _ <- 1 to 10_000 do
      val bytes = random.nextInt(4) match
        case 0 => random.nextBytes(random.nextInt(200))
        case 1 => whole.take(random.nextInt(whole.length))
        case 2 => whole ++ random.nextBytes(1 + random.nextInt(50))
        case _ => whole.updated(random.nextInt(2), (random.nextInt(255) - 127).toByte).take(39)
      other.hear(bytes, Span.Zero)
    assertEquals(
      (other.damaged, other.isWaiting, other.rotors),
      (10_000L, true, AutopilotInterface.MotorsOff)
    )
