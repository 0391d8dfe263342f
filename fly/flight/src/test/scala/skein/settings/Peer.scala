package skein.settings

import java.io.{DataInputStream, IOException}
import java.net.{StandardProtocolFamily, UnixDomainSocketAddress}
import java.nio.ByteBuffer
import java.nio.channels.{Channels, ServerSocketChannel}
import java.nio.file.Files
import java.util.concurrent.atomic.AtomicInteger

/** A policy behind a socket, which a flight cannot distinguish from another process.
  *
  * @param answer maps the number of the request, from 0, and the observation to the bytes of the answer; None
  *   ends the connection
  */
final class Peer(answer: (Int, Vector[Float]) => Option[Array[Byte]]) extends AutoCloseable:
  private val folder   = Files.createTempDirectory("skein-peer")
  private val path     = folder.resolve("policy")
  private val listener =
    ServerSocketChannel.open(StandardProtocolFamily.UNIX).bind(UnixDomainSocketAddress.of(path))
  private val count = AtomicInteger()

  val option: String = s"unix:pursuer:$path"

  def asked: Int = count.get

  private val serving = Thread.ofPlatform().daemon().start: () =>
    try
      val client    = listener.accept()
      val questions = DataInputStream(Channels.newInputStream(client))
      try
        while true do
          val seen = Vector.fill(9)(questions.readFloat())
          answer(count.getAndIncrement(), seen) match
            case Some(bytes) => client.write(ByteBuffer.wrap(bytes)): Unit
            case None        => throw IOException("enough")
      finally client.close()
    catch case _: IOException => ()

  def close(): Unit =
    serving.interrupt()
    serving.join()
    listener.close()
    Files.deleteIfExists(path): Unit
    Files.delete(folder)

object Peer:
  def number(share: Float): Array[Byte] = ByteBuffer.allocate(5).put(0.toByte).putFloat(share).array

  def refusal(reason: String): Array[Byte] =
    val told = reason.getBytes("UTF-8")
    ByteBuffer.allocate(5 + told.length).put(1.toByte).putInt(told.length).put(told).array

  def pursuer(seen: Vector[Float]): Array[Byte] =
    number(if seen(1) != 0 then math.signum(seen(1)) else if seen(0) < 0 then 1 else 0)
