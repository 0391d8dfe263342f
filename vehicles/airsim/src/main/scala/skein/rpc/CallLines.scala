package skein.rpc

import java.util.ArrayDeque
import java.util.concurrent.atomic.{AtomicBoolean, LongAdder}
import java.util.concurrent.{ConcurrentHashMap, ConcurrentLinkedQueue}
import scala.jdk.CollectionConverters.*

/** Calls that wait to be run: one queue for each connection, served in rounds. Calls of one connection keep
  * their order.
  *
  * A call that enters an empty queue goes ahead of all waiting calls, as long as its connection has had less
  * than `share` calls in the round: so a client that calls rarely hardly waits for clients that call without
  * a pause. From a longer queue, `batch` calls are taken in a row: waking a connection for an answer costs
  * more than running most calls, so it is woken once for several. The first call of a queue waits for at most
  * `share` calls of every other connection.
  *
  * While nothing else can be run, [[takeUrgent]] returns calls that need not wait for other calls.
  *
  * Any thread may add and forget calls; one thread takes them. The server bounds the number of waiting calls
  * by limiting each connection's unanswered calls.
  */
final class CallLines[Call](share: Int = 16, batch: Int = 4, isUrgent: Call => Boolean = (_: Call) => false):
  require(share >= batch && batch > 0, s"a batch, $batch, must be positive and within the share, $share")

  private final class Place(val line: Line, val call: Call):
    @volatile var isTaken = false

  private final class Line:
    val calls  = ConcurrentLinkedQueue[Place]()
    val inTurn = AtomicBoolean()

    // The remaining fields belong to the taking thread.
    var round = -1L
    var taken = 0 // in that round

  private val lines  = ConcurrentHashMap[Long, Line]()
  private val came   = ConcurrentLinkedQueue[Line]() // had been empty
  private val urgent = ConcurrentLinkedQueue[Place]()
  private val gone   = LongAdder()

  // Lines of the taking thread: in this round those that had been empty, then the others; and the next round.
  private val first = ArrayDeque[Line]()
  private var turns = ArrayDeque[Line]()
  private var later = ArrayDeque[Line]()
  private var round = 0L

  def dropped: Long = gone.sum

  def isEmpty: Boolean = came.isEmpty && first.isEmpty && turns.isEmpty && later.isEmpty

  def put(connection: Long, call: Call): Unit =
    val line  = lines.computeIfAbsent(connection, _ => Line())
    val place = Place(line, call)
    val _     = line.calls.add(place)
    if isUrgent(call) then urgent.add(place): Unit
    if line.inTurn.compareAndSet(false, true) then
      val _ = came.add(line)

  /** Takes the call whose turn it is, if any waits. */
  @annotation.tailrec
  def take(): Option[Call] =
    sort()
    val sparse = !first.isEmpty
    val line   = if sparse then first.poll() else turns.poll()
    if line == null then None
    else
      val place = line.calls.poll()
      if place != null then
        line.taken += 1
        place.isTaken = true
        forgetTaken()
      if line.calls.isEmpty then
        line.inTurn.set(false)
        // A line may have been added between the two checks.
        if !line.calls.isEmpty && line.inTurn.compareAndSet(false, true) then
          val _ = came.add(line)
      else if line.taken >= batch then later.add(line): Unit
      else if sparse then turns.add(line): Unit
      else turns.addFirst(line)
      if place == null then take() else Some(place.call)

  /** Takes the first urgent call ahead of all that wait, together with the earlier calls of its connection
    * that it makes needless.
    *
    * @param supersedes whether the first call makes the other one needless
    */
  @annotation.tailrec
  def takeUrgent(supersedes: (Call, Call) => Boolean): Option[(call: Call, superseded: Vector[Call])] =
    forgetTaken()
    val place = urgent.poll()
    if place == null then None
    else
      val before = place.line.calls.iterator.asScala.takeWhile(_ ne place).toVector
      if !takeOut(place) then takeUrgent(supersedes)
      else
        val needless = before.filter(other => supersedes(place.call, other.call)).filter(takeOut)
        Some((place.call, needless.map(_.call)))

  def hasUrgent: Boolean =
    forgetTaken()
    !urgent.isEmpty

  private def takeOut(place: Place): Boolean =
    place.isTaken = true
    place.line.calls.remove(place)

  private def forgetTaken(): Unit = while Option(urgent.peek()).exists(_.isTaken) do urgent.poll(): Unit

  /** Drops the calls of a closed connection: their answers have no receiver. */
  def forget(connection: Long): Unit =
    val line = lines.remove(connection)
    if line != null then
      for place <- Iterator.continually(line.calls.poll()).takeWhile(_ != null) do
        place.isTaken = true
        gone.increment()

  /** Moves newly filled queues into the round, and begins a round when the last has ended. */
  private def sort(): Unit =
    for line <- Iterator.continually(came.poll()).takeWhile(_ != null) do
      if line.round != round then
        line.round = round
        line.taken = 0
      (if line.taken < share then first else later).add(line): Unit
    if first.isEmpty && turns.isEmpty && !later.isEmpty then
      round += 1
      val over = turns
      turns = later
      later = over
      turns.forEach: line =>
        line.round = round
        line.taken = 0
