package skein.simulator

import java.net.{DatagramPacket, DatagramSocket, InetAddress}
import java.nio.{ByteBuffer, ByteOrder}

/** Betaflight's remote control: moves the sticks of its SITL (`rc_packet`), and receives its motors' pulses
  * (`servo_packet_raw`).
  */
private final class RemoteControl extends AutoCloseable:
  import RemoteControl.*

  private val loopback = InetAddress.getLoopbackAddress
  private val sender   = DatagramSocket()
  private val receiver = DatagramSocket(Betaflight.PulsesPort, loopback)

  /** Number of motor updates so far. */
  @volatile var updates: Long = 0L

  /** The longest time between two updates since it was reset to 0, ns. */
  @volatile var longestPauseNanos: Long = 0L

  @volatile var isArmed = false

  Thread.ofPlatform.daemon.start: () =>
    val packet = DatagramPacket(new Array[Byte](PulsesLength), PulsesLength)
    val pulses = ByteBuffer.wrap(packet.getData).order(ByteOrder.LITTLE_ENDIAN)
    var before = System.nanoTime
    try
      while true do
        receiver.receive(packet)
        val now = System.nanoTime
        longestPauseNanos = longestPauseNanos.max(now - before)
        before = now
        updates += 1
        isArmed = (0 until 4).forall(motor => pulses.getFloat(FirstPulseAt + 4 * motor) > StoppedUs)
    catch case _: java.net.SocketException => () // closed

  /** Roll to the right, pitch forwards and yaw to the right from −1 to 1, throttle from 0 to 1. */
  def move(roll: Double, pitch: Double, throttle: Double, yaw: Double, arms: Boolean): Unit =
    val packet                 = ByteBuffer.allocate(8 + 16 * 2).order(ByteOrder.LITTLE_ENDIAN)
    def centred(value: Double) = (1500 + 500 * value.max(-1).min(1)).round.toShort
    val channels               = Vector(
      centred(roll),
      centred(pitch),
      (1000 + 1000 * throttle.max(0).min(1)).round.toShort,
      centred(yaw),
      if arms then 2000.toShort else 1000.toShort
    )
    packet.putDouble(0)
    channels.padTo(16, 1000.toShort).foreach(packet.putShort)
    sender.send(DatagramPacket(packet.array, packet.capacity, loopback, Betaflight.RcPort))

  def close(): Unit =
    sender.close()
    receiver.close()

private object RemoteControl:
  /** Length of a datagram: number of motors, two unused bytes, sixteen floats in microseconds. */
  private val PulsesLength = 4 + 16 * 4
  private val FirstPulseAt = 4
  private val StoppedUs    = 1000
