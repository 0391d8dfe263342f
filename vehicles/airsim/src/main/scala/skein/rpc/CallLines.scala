package skein.rpc

import java.util.ArrayDeque
import java.util.concurrent.atomic.{AtomicBoolean, LongAdder}
import java.util.concurrent.{ConcurrentHashMap, ConcurrentLinkedQueue}

/** Calls that wait to be run: a line for each connection, from which calls are taken in rounds. Calls of one
  * connection keep their order.
  *
  * A call that comes to an empty line goes before all that wait, as long as its line has had less than
  * `share` in the round: so a client that asks now and then hardly waits for those that ask without a pause.
  * Of a line in which calls wait `batch` are taken in a round, one after another: to wake a connection for an
  * answer costs more than to run most calls, and so it is woken once for several. No call that is first in
  * its line waits for more than `share` calls of every other connection.
  *
  * Any thread may put and forget, one takes. What waits is bounded by the server, which lets each connection
  * have a limited number of calls unanswered.
  */
final class CallLines[Call](share: Int = 16, batch: Int = 4):
  require(share >= batch && batch > 0, s"a batch, $batch, must be positive and within the share, $share")

  private final class Line:
    val calls  = ConcurrentLinkedQueue[Call]()
    val inTurn = AtomicBoolean()

    // The rest is the taker's.
    var round = -1L
    var taken = 0 // in that round

  private val lines = ConcurrentHashMap[Long, Line]()
  private val came  = ConcurrentLinkedQueue[Line]() // had been empty
  private val gone  = LongAdder()

  // The taker's: of this round, first those that had been empty; of the next one.
  private val first = ArrayDeque[Line]()
  private var turns = ArrayDeque[Line]()
  private var later = ArrayDeque[Line]()
  private var round = 0L

  /** Calls forgotten so far. */
  def dropped: Long = gone.sum

  /** By the thread that takes. */
  def isEmpty: Boolean = came.isEmpty && first.isEmpty && turns.isEmpty && later.isEmpty

  def put(connection: Long, call: Call): Unit =
    val line = lines.computeIfAbsent(connection, _ => Line())
    val _    = line.calls.add(call)
    if line.inTurn.compareAndSet(false, true) then
      val _ = came.add(line)

  /** The call whose turn it is. */
  @annotation.tailrec
  def take(): Option[Call] =
    sort()
    val sparse = !first.isEmpty
    val line   = if sparse then first.poll() else turns.poll()
    if line == null then None
    else
      val call = line.calls.poll()
      if call != null then line.taken += 1
      if line.calls.isEmpty then
        line.inTurn.set(false)
        // One may have come between the two.
        if !line.calls.isEmpty && line.inTurn.compareAndSet(false, true) then
          val _ = came.add(line)
      else if line.taken >= batch then later.add(line): Unit
      else if sparse then turns.add(line): Unit
      else turns.addFirst(line)
      if call == null then take() else Some(call)

  /** The connection has closed: nobody waits for its calls, and they are not to be run. */
  def forget(connection: Long): Unit =
    val line = lines.remove(connection)
    if line != null then while line.calls.poll() != null do gone.increment()

  /** Gives every line that has come its place, and begins a round when the last is over. */
  private def sort(): Unit =
    var line = came.poll()
    while line != null do
      if line.round != round then
        line.round = round
        line.taken = 0
      (if line.taken < share then first else later).add(line): Unit
      line = came.poll()
    if first.isEmpty && turns.isEmpty && !later.isEmpty then
      round += 1
      val over = turns
      turns = later
      later = over
      turns.forEach: line =>
        line.round = round
        line.taken = 0
