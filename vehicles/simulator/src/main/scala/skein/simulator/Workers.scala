package skein.simulator

import scala.collection.mutable.{ArrayBuffer, Queue}
import skein.units.*

/** Which request runs when, as in AirSim's server: a fixed number of worker threads, one lock per vehicle.
  *
  * A request waits until a worker is free. A move holds its worker until it ends, and its vehicle's lock. A
  * move that finds the lock taken cancels the one that holds it, and gets the lock a little later. That is
  * AirSim's flaw: another move that comes within this while sees nothing left to cancel and waits behind, for
  * the whole of the one before it. A burst of moves thus runs to the end of many, and holds so many workers
  * that all else waits.
  *
  * The worker of the move that has ended takes the next request at once. Whether it or the lock on its way is
  * first is a race, in which the lock wins 5 times of 8 here, evenly spread: then a move that the worker
  * takes cancels the one that has just got the lock. Seen at AirSim: a burst of 8 four-second moves on two
  * vehicles' six workers holds a ping up for 4 s, one of 20 for 24 s. From these two figures is that share.
  *
  * Pure bookkeeping: it is told the time, and the caller does what it says. What waits is bounded by who
  * calls: a server lets each connection have a limited number of requests unanswered.
  *
  * @param limit number of workers; AirSim has one for each vehicle and four more
  * @param handover how long a lock is on its way to the move that waits; zero lets the newest move win always
  */
final class Workers[Job, Flight](limit: Int, vehicles: Int, handover: Span):
  require(limit > 0, s"the number of workers must be positive, not $limit")

  private val jobs  = Queue.empty[Job]
  private val locks = ArrayBuffer.fill(vehicles)(Lock())
  private var busy  = 0
  private var race  = 3

  final private class Lock:
    val waiting    = Queue.empty[Flight]
    var held       = false
    var handoverAt = Option.empty[Instant]

  /** One more vehicle has a lock; the number of workers stays, as in AirSim. */
  def addVehicle(): Unit = locks += Lock()

  /** Whether a request offered now is run at once. */
  def isFree: Boolean = busy < limit && jobs.isEmpty

  def offer(job: Job): Unit = jobs.enqueue(job)

  /** The next request, if a worker is free for it. */
  def take(): Option[Job] = Option.when(busy < limit && jobs.nonEmpty)(jobs.dequeue())

  /** The request taken is a move: its worker is held from now on. True: it has the lock and starts. False: it
    * waits, and the vehicle's move is to be cancelled.
    */
  def acquire(vehicle: Int, flight: Flight): Boolean =
    val lock = locks(vehicle)
    busy += 1
    val free = !lock.held && lock.waiting.isEmpty
    if free then lock.held = true else lock.waiting.enqueue(flight)
    free

  /** The vehicle's move has ended: its worker is free, and its lock goes to the next. */
  def release(vehicle: Int, at: Instant): Unit =
    val lock = locks(vehicle)
    busy -= 1
    lock.held = false
    if lock.waiting.nonEmpty then
      lock.handoverAt = Some(if jobs.nonEmpty && lockIsFirst() then at else at + handover)

  private def lockIsFirst(): Boolean =
    race = (race + 5) % 8
    race < 5

  /** When the next lock arrives at a move that waits for it. */
  def nextHandover: Option[Instant] =
    var next = Option.empty[Instant]
    for lock <- locks; at <- lock.handoverAt do if next.forall(at < _) then next = lock.handoverAt
    next

  /** When the last of those under way arrives. */
  def lastHandover: Option[Instant] = locks.flatMap(_.handoverAt).maxOption

  /** A move whose lock has arrived by `at`; it starts. */
  def handOver(at: Instant): Option[(Int, Flight)] =
    locks.indices
      .filter(vehicle => locks(vehicle).handoverAt.exists(_ <= at))
      .minByOption(vehicle => locks(vehicle).handoverAt)
      .map: vehicle =>
        val lock = locks(vehicle)
        lock.handoverAt = None
        lock.held = true
        (vehicle, lock.waiting.dequeue())
