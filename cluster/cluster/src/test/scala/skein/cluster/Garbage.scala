package skein.cluster

import java.io.IOException
import java.net.Socket
import java.nio.ByteOrder.LITTLE_ENDIAN
import java.nio.{ByteBuffer, ByteOrder}
import java.util.Random

/** A stranger's data, by seed: noise, other protocols, Pekko's own wire and TLS's with false lengths. */
private[cluster] object Garbage:

  /** Data of the kind that the number selects: the kinds take turns. */
  def of(number: Int): Array[Byte] =
    val random = Random(number)
    kinds(number % kinds.size)(random)

  /** Sends each number's data over a connection of its own, and closes it in one of three ways. */
  def send(port: Int, numbers: Range)(kind: Int => Array[Byte]): Unit =
    for number <- numbers do
      val socket = Socket("127.0.0.1", port)
      try
        socket.getOutputStream.write(kind(number))
        number % 3 match
          case 0 => socket.shutdownOutput()
          case 1 => socket.setSoLinger(true, 0) // Closed with a reset.
          case _ => ()
      catch case _: IOException => () // Closed in the middle of the data.
      finally socket.close()

  /** Data that Pekko would read endlessly: see [[FrameCheck]]. */
  def endless(number: Int): Array[Byte] =
    val random = Random(number)
    lying(random, if random.nextBoolean() then Int.MaxValue else -1 - random.nextInt(1 << 30))

  private def lying(random: Random, of: Int) =
    pekko(1 + random.nextInt(3)) ++ length(of, LITTLE_ENDIAN) ++ noise(random, 4096)

  private def noise(random: Random, most: Int): Array[Byte] =
    val bytes = Array.ofDim[Byte](1 + random.nextInt(most))
    random.nextBytes(bytes)
    bytes

  private def text(of: String) = of.getBytes("US-ASCII")

  /** The first bytes of a Pekko connection, with the stream's number. */
  private def pekko(stream: Int) = text("AKKA") :+ stream.toByte

  private def length(bytes: Int, order: ByteOrder) = ByteBuffer.allocate(4).order(order).putInt(bytes).array

  private def frame(content: Array[Byte]) = length(content.length, LITTLE_ENDIAN) ++ content

  private val kinds: Vector[Random => Array[Byte]] = Vector(
    noise(_, 32),
    noise(_, 64 << 10),
    random => Array.fill(1 + random.nextInt(4096))(random.nextInt(2).toByte),
    random => text(s"GET /${"a" * random.nextInt(8192)} HTTP/1.1\r\nHost: skein\r\n\r\n"),
    // A length of a GiB, or of one byte more than allowed, with few bytes after it.
    random =>
      val lie = if random.nextBoolean() then 1 << 30 else MessageCodec.MostBytes + (64 << 10) + 1
      lying(random, lie)
    ,
    // Frames of the stated length, with noise for the envelope and the message.
    random =>
      pekko(1 + random.nextInt(3)) ++ Array.fill(1 + random.nextInt(8))(frame(noise(random, 512))).flatten,
    // The envelope begins like a valid one.
    random => pekko(1 + random.nextInt(3)) ++ frame(Array[Byte](0, 0) ++ noise(random, 512)),
    random => pekko(random.nextInt(256)) ++ frame(noise(random, 64)),
    // TLS: a noisy ClientHello, a truncated one, and an alert.
    random =>
      val content = noise(random, 512)
      Array[Byte](22, 3, 1) ++ length(content.length, ByteOrder.BIG_ENDIAN).drop(2) ++ content
    ,
    random => Array[Byte](22, 3, 1, 127, -1, 1, 0) ++ noise(random, 256),
    random => Array[Byte](21, 3, 3, 0, 2, 2, random.nextInt(256).toByte)
  )
