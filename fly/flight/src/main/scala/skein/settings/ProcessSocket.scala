package skein.settings

import java.io.IOException
import java.net.UnixDomainSocketAddress
import java.nio.ByteBuffer
import java.nio.channels.{SelectionKey, Selector, SocketChannel}
import skein.units.{Clock, Instant, Span}

/** A connection to another process, over a Unix socket: requests, and an answer to each. Calls block; a
  * request and its answer together for no longer than `answerWithin` of real time. Not thread-safe.
  *
  * Every call throws an [[IOException]] if the process has ended or does not answer in time.
  */
private[skein] final class ProcessSocket(path: String, answerWithin: Span) extends AutoCloseable:
  private val channel        = SocketChannel.open(UnixDomainSocketAddress.of(path))
  private val selector       = Selector.open()
  private val key            = channel.configureBlocking(false).register(selector, SelectionKey.OP_READ)
  private var until: Instant = Clock.system.now()

  /** Whether data without a request was received since the last answer. */
  def isAhead: Boolean = channel.read(ByteBuffer.allocate(1)) match
    case n if n < 0 => throw IOException(ProcessSocket.Ended)
    case n          => n > 0

  /** Sends a request completely, and starts its time-out. */
  def ask(question: ByteBuffer): Unit =
    until = Clock.system.now() + answerWithin
    while question.hasRemaining do if channel.write(question) == 0 then await(SelectionKey.OP_WRITE)

  /** Reads the next bytes of an answer, at least one. */
  def read(into: ByteBuffer): Unit =
    await(SelectionKey.OP_READ)
    if channel.read(into) < 0 then throw IOException(ProcessSocket.Ended)

  def read(bytes: Int): ByteBuffer =
    val buffer = ByteBuffer.allocate(bytes)
    while buffer.hasRemaining do read(buffer)
    buffer.flip()

  def close(): Unit =
    selector.close()
    channel.close()

  private def await(operation: Int): Unit =
    key.interestOps(operation): Unit
    val leftMs = until.since(Clock.system.now()).toMillis.ceil.toLong
    if leftMs <= 0 || selector.select(leftMs) == 0 then
      throw IOException(s"expected an answer within ${answerWithin.toMillis.round} ms, got none")
    selector.selectedKeys.clear()

private[skein] object ProcessSocket:
  private val Ended = "its process has ended"

  /** Another process's text on one line, without control characters: it must not command a terminal. */
  def plain(text: String): String = text.replaceAll("\\p{Cntrl}+", " ").trim
