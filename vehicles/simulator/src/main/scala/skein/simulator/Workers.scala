package skein.simulator

import scala.collection.mutable.{ArrayBuffer, Queue}
import skein.units.*

/** Decides when each request runs, as AirSim's server does with a fixed number of worker threads and one lock
  * per vehicle.
  *
  * A request waits until a worker is free. A move holds its worker until it ends, and its vehicle's lock. A
  * move that finds the lock taken cancels the one that holds it, and receives the lock a little later. That
  * is AirSim's flaw: another move that arrives in between finds nothing left to cancel and waits for the
  * whole of the move before it. In a burst many moves thus run to their end, and hold enough workers that all
  * other calls wait.
  *
  * The worker of the move that has ended takes the next request immediately. It races with the lock's
  * handover, which here is first 5 times of 8, evenly spread: then a move that the worker takes cancels the
  * one that has just received the lock. Observed with AirSim: a burst of 8 four-second moves on two vehicles'
  * six workers holds a ping up for 4 s, one of 20 for 24 s. The share is fitted to these two figures.
  *
  * A client that has left holds no worker: its last move continues until another client's move arrives.
  *
  * Pure bookkeeping: the caller passes the time and carries out the decisions. The queue is bounded by the
  * caller: a server lets each connection have a limited number of requests unanswered.
  *
  * @param limit number of workers; AirSim has one for each vehicle and four more
  * @param handover time until a released lock reaches the waiting move; zero lets the newest move always win
  */
final class Workers[Job, Flight](limit: Int, vehicles: Int, handover: Span):
  require(limit > 0, s"the number of workers must be positive, not $limit")

  private val jobs  = Queue.empty[Job]
  private val locks = ArrayBuffer.fill(vehicles)(Lock())
  private var busy  = 0
  private var race  = 3

  /** A move that has a vehicle's lock, or waits for it. */
  final private class Claim(val flight: Flight, val client: Long):
    private var hasWorker = true
    busy += 1

    def isLeft: Boolean = !hasWorker

    def freeWorker(): Unit =
      if hasWorker then busy -= 1
      hasWorker = false

  final private class Lock:
    val waiting    = Queue.empty[Claim]
    var holder     = Option.empty[Claim]
    var handoverAt = Option.empty[Instant]

  /** Adds a lock for one more vehicle; the number of workers does not change, as in AirSim. */
  def addVehicle(): Unit = locks += Lock()

  /** Whether a request offered now is run immediately. */
  def isFree: Boolean = busy < limit && jobs.isEmpty

  def isFull: Boolean = busy >= limit

  def offer(job: Job): Unit = jobs.enqueue(job)

  /** Takes the next request, if a worker is free for it.
    *
    * @param isOpen whether every request gets a worker
    */
  def take(isOpen: Boolean = false): Option[Job] =
    Option.when((isOpen || busy < limit) && jobs.nonEmpty)(jobs.dequeue())

  /** Removes needless requests that waited for a worker, and returns them. */
  def drop(isNeedless: Job => Boolean): Vector[Job] = jobs.dequeueAll(isNeedless).toVector

  /** Turns the request just taken into a move, which holds its worker from now on. True if it has the lock
    * and starts; false if it waits, and the vehicle's current move must be cancelled.
    *
    * @param client the client that made the request
    * @param isLeft whether the client has left in the meantime
    */
  def acquire(vehicle: Int, flight: Flight, client: Long = 0, isLeft: Boolean = false): Boolean =
    val lock  = locks(vehicle)
    val claim = Claim(flight, client)
    if isLeft then claim.freeWorker()
    val free = lock.holder.isEmpty && lock.waiting.isEmpty
    if free then lock.holder = Some(claim) else lock.waiting.enqueue(claim)
    free

  /** Ends the vehicle's move: frees its worker, and hands its lock to the next. */
  def release(vehicle: Int, at: Instant): Unit =
    val lock = locks(vehicle)
    lock.holder.foreach(_.freeWorker())
    lock.holder = None
    if lock.waiting.nonEmpty then
      lock.handoverAt = Some(if jobs.nonEmpty && lockIsFirst() then at else at + handover)

  /** Removes moves that wait for the vehicle's lock.
    *
    * @param all whether to remove all of them; else only the moves of clients that have left
    */
  def dismiss(vehicle: Int, all: Boolean): Vector[Flight] =
    val lock = locks(vehicle)
    dismissed(lock, claim => all || claim.isLeft)

  /** Handles a client's departure: its moves hold no workers any more. Of its moves that wait for a vehicle's
    * lock only the newest stays.
    *
    * @return the others
    */
  def leave(client: Long): Vector[Flight] = locks.toVector.flatMap: lock =>
    lock.holder.filter(_.client == client).foreach(_.freeWorker())
    val own = lock.waiting.filter(_.client == client)
    own.lastOption.foreach(_.freeWorker())
    dismissed(lock, own.dropRight(1).contains)

  private def dismissed(lock: Lock, which: Claim => Boolean): Vector[Flight] =
    val gone = lock.waiting.dequeueAll(which).toVector
    gone.foreach(_.freeWorker())
    if lock.waiting.isEmpty then lock.handoverAt = None
    gone.map(_.flight)

  private def lockIsFirst(): Boolean =
    race = (race + 5) % 8
    race < 5

  /** The time at which the next waiting move receives its lock. */
  def nextHandover: Option[Instant] =
    var next = Option.empty[Instant]
    for lock <- locks; at <- lock.handoverAt do if next.forall(at < _) then next = lock.handoverAt
    next

  /** The time at which the last lock in transit arrives. */
  def lastHandover: Option[Instant] = locks.flatMap(_.handoverAt).maxOption

  /** Takes a move whose lock has arrived by `at`; it starts. */
  def handOver(at: Instant): Option[(Int, Flight)] =
    locks.indices
      .filter(vehicle => locks(vehicle).handoverAt.exists(_ <= at))
      .minByOption(vehicle => locks(vehicle).handoverAt)
      .map: vehicle =>
        val lock  = locks(vehicle)
        val claim = lock.waiting.dequeue()
        lock.handoverAt = None
        lock.holder = Some(claim)
        (vehicle, claim.flight)
