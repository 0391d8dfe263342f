package skein.ros

import java.lang.foreign.ValueLayout.{ADDRESS, JAVA_BYTE, JAVA_LONG}
import java.lang.foreign.{Arena, MemorySegment}
import java.util.concurrent.atomic.AtomicLong
import skein.ros.message.{Cdr, MessageType}

/** A topic that a node publishes. Its methods may be called from any thread; after the node's end they do
  * nothing.
  */
final class RosPublisher[A] private[ros] (
    library: RosLibrary,
    publisher: MemorySegment,
    allocator: MemorySegment,
    failures: AtomicLong
)(using kind: MessageType[A]):
  import RosPublisher.*

  private var room    = Arena.ofShared()
  private var message = envelope(FirstBytes)
  private var isOpen  = true
  private val readers = Arena.ofAuto().allocate(8, 8)

  /** An `rcutils_uint8_array_t` with its bytes: address, size, capacity, and an allocator. */
  private def envelope(bytes: Long): MemorySegment =
    val made = room.allocate(24 + RosLibrary.AllocatorLayout.byteSize, 8)
    made.set(ADDRESS, 0, room.allocate(bytes, 8))
    made.set(JAVA_LONG, 16, bytes)
    MemorySegment.copy(allocator, 0, made, 24, RosLibrary.AllocatorLayout.byteSize)
    made

  /** Hands a message to the middleware, which may wait for slow reliable readers for up to 100 ms. */
  def publish(value: A): Unit =
    val bytes = Cdr.bytes(value)(using kind.cdr)
    synchronized:
      if isOpen then
        if message.get(JAVA_LONG, 16) < bytes.length then
          room.close()
          room = Arena.ofShared()
          message = envelope(2L * bytes.length)
        val into = message.get(ADDRESS, 0).reinterpret(message.get(JAVA_LONG, 16))
        MemorySegment.copy(bytes, 0, into, JAVA_BYTE, 0, bytes.length)
        message.set(JAVA_LONG, 8, bytes.length)
        val status = library.status(library.publish, publisher, message, MemorySegment.NULL)
        if status != RosLibrary.Ok then
          library.reason(status): Unit
          failures.incrementAndGet(): Unit

  /** Whether a subscription of any node matches it now; false after the end of its node. */
  def isRead: Boolean = synchronized:
    isOpen && {
      library.status(library.readersOf, publisher, readers) == RosLibrary.Ok && readers.get(JAVA_LONG, 0) > 0
    }

  private[ros] def close(node: MemorySegment): Unit = synchronized:
    if isOpen then
      isOpen = false
      library.call(library.endSender, publisher, node)
      room.close()

private object RosPublisher:
  private val FirstBytes = 1024L
