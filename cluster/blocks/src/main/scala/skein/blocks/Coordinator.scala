package skein.blocks

import scala.collection.immutable.TreeSet

/** Assigns blocks to workers: an immutable value, changed by workers' messages and by time. Blocks may be
  * assigned several times; the first answer counts, and later ones are counted as repeats.
  *
  * @param waiting blocks without a worker
  * @param leases blocks with at least one worker, keyed by number
  * @param seldom leases of a single worker, the oldest first; they are assigned again once nothing waits
  * @param workers records of the workers by name, including those that have left
  * @param cores number of cores of all current workers
  * @param patienceNanos time after which a block is assigned to other workers too, whatever its worker does
  * @param slowNanos time after which a block may go to a second worker, once nothing waits
  */
final case class Coordinator private (
    waiting: Waiting,
    leases: Map[Long, Coordinator.Lease],
    seldom: TreeSet[(Long, Long)],
    workers: Map[String, WorkerRecord],
    counts: Coordinator.Counts,
    cores: Int,
    patienceNanos: Long,
    slowNanos: Long
):
  import Coordinator.*

  def isIdle: Boolean = waiting.isEmpty && leases.isEmpty

  def joined(worker: String, cores: Int): Coordinator =
    val record = workers.getOrElse(worker, WorkerRecord(cores, isHere = false))
    val before = if record.isHere then record.cores else 0
    copy(
      workers = workers.updated(worker, record.copy(cores = cores, isHere = true)),
      cores = this.cores - before + cores
    )

  /** Removes a lost worker; blocks that only this worker had wait again, ahead of all other blocks. */
  def lost(worker: String): Coordinator =
    workers.get(worker).filter(_.isHere).fold(this): record =>
      released(worker, record.holds).copy(
        workers = workers.updated(worker, record.copy(isHere = false, holds = Map.empty)),
        cores = cores - record.cores
      )

  def offered(blocks: Iterable[Block]): Coordinator = copy(waiting = waiting.followedBy(blocks))

  /** Handles a worker's request for a block. A worker holds one block for each of its cores, and as many
    * again, which wait there, while more blocks wait than there are cores.
    *
    * @param holding numbers of the blocks that it has; a block missing here is lost if it was assigned or
    *   last listed more than [[OnItsWay]] ago
    * @param nowNanos the present time, on any monotonic clock
    * @return the assigned block, if there is one
    */
  def asked(worker: String, holding: Set[Long], nowNanos: Long): (Coordinator, Option[Block]) =
    workers.get(worker).filter(_.isHere) match
      case None         => (this, None)
      case Some(record) =>
        // An answer in transit may be overtaken by the request after it.
        val seen =
          record.holds.map((number, since) => number -> (if holding(number) then nowNanos else since))
        val gone = seen.filter((number, since) => !holding(number) && nowNanos - since > OnItsWay)
        val here = copy(workers = workers.updated(worker, record.copy(holds = seen -- gone.keySet)))
          .released(worker, gone)
        val most = if waiting.size >= cores then MostHeld * record.cores else record.cores
        if holding.size.max(here.workers(worker).holds.size) >= most then (here, None)
        else here.handedOut(worker, nowNanos)

  /** Handles a worker's answer.
    *
    * @return the block, if this is its first answer, which counts
    */
  def answered(worker: String, number: Long, busyNanos: Long): (Coordinator, Option[Block]) =
    val lease = leases.get(number)
    // If its lease was dropped, a block waits, and its answer may arrive nevertheless.
    val block    = lease.map(_.block).orElse(waiting.again.get(number))
    val accepted = if block.isDefined then 1 else 0
    val freed    = lease.fold(copy(waiting = waiting.without(number)))(without(_))
    val record   = freed.workers.getOrElse(worker, WorkerRecord(0, isHere = false))
    val told     = record.copy(
      holds = record.holds - number,
      accepted = record.accepted + accepted,
      repeated = record.repeated + 1 - accepted,
      busyNanos = record.busyNanos + busyNanos
    )
    val next = freed.copy(
      workers = freed.workers.updated(worker, told),
      counts = counts.copy(accepted = counts.accepted + accepted, repeated = counts.repeated + 1 - accepted)
    )
    (next, block)

  /** Returns overdue blocks to the waiting ones; their workers may still answer. */
  def at(nowNanos: Long): Coordinator =
    def isOverdue(lease: Lease) = nowNanos - lease.place._1 > patienceNanos
    // Towards the end every block may be with two workers that both hang.
    val overdue =
      if seldom.isEmpty then leases.valuesIterator.filter(isOverdue).toVector
      else seldom.iterator.map((_, number) => leases(number)).takeWhile(isOverdue).toVector
    overdue.foldLeft(this): (here, lease) =>
      here.returned(lease, here.counts.copy(overdue = here.counts.overdue + 1))

  /** Drops all blocks; answers that still arrive are repeats. */
  def cancelled: Coordinator = copy(
    waiting = Waiting(),
    leases = Map.empty,
    seldom = TreeSet.empty,
    workers = workers.view.mapValues(_.copy(holds = Map.empty)).toMap
  )

  private def handedOut(worker: String, nowNanos: Long): (Coordinator, Option[Block]) =
    waiting.next match
      case Some((block, others)) =>
        (copy(waiting = others).leased(Lease(block, Map.empty), worker, nowNanos), Some(block))
      case None =>
        // The last blocks are assigned twice: the faster answer counts.
        val slow = seldom.iterator
          .takeWhile((since, _) => nowNanos - since >= slowNanos)
          .map((_, number) => leases(number))
          .find(!_.holders.contains(worker))
        slow.fold((this, None)): lease =>
          val next = copy(seldom = seldom - lease.place, counts = counts.copy(doubled = counts.doubled + 1))
          (next.leased(lease, worker, nowNanos), Some(lease.block))

  private def leased(lease: Lease, worker: String, nowNanos: Long): Coordinator =
    val now    = lease.copy(holders = lease.holders.updated(worker, nowNanos))
    val record = workers(worker)
    copy(
      leases = leases.updated(lease.block.number, now),
      seldom = if now.holders.size == 1 then seldom + now.place else seldom,
      workers = workers.updated(
        worker,
        record.copy(holds = record.holds.updated(lease.block.number, nowNanos))
      )
    )

  /** Ends a lease, also in the records of the workers that have its block. */
  private def without(lease: Lease): Coordinator =
    val number = lease.block.number
    val freed  = lease.holders.keys.foldLeft(workers): (all, holder) =>
      all.updatedWith(holder)(_.map(record => record.copy(holds = record.holds - number)))
    copy(leases = leases - number, seldom = seldom - lease.place, workers = freed)

  private def returned(lease: Lease, counted: Counts): Coordinator =
    without(lease).copy(waiting = waiting.returned(lease.block), counts = counted)

  /** Removes a worker from leases; blocks without another worker wait again. */
  private def released(worker: String, held: Map[Long, Long]): Coordinator =
    held.keys.toVector.sorted.foldRight(this): (number, here) =>
      here.leases.get(number).filter(_.holders.contains(worker)).fold(here): lease =>
        val left = lease.copy(holders = lease.holders - worker)
        if left.holders.isEmpty then here.returned(lease, here.counts.copy(lost = here.counts.lost + 1))
        else here.copy(leases = here.leases.updated(number, left), seldom = here.seldom + left.place)

object Coordinator:
  /** Maximum number of a worker's blocks for each core: one being computed, and one that waits at the worker.
    */
  val MostHeld = 2

  /** Time for which an assigned block, or the answer to one that its worker listed, may still be in transit:
    * twice a worker's longest interval between two requests.
    */
  val OnItsWay: Long = 4_000_000_000L

  val Patience: Long = 600_000_000_000L

  def apply(patienceNanos: Long = Patience, slowNanos: Long = 0): Coordinator =
    Coordinator(
      Waiting(),
      Map.empty,
      TreeSet.empty,
      Map.empty,
      Counts(0, 0, 0, 0, 0),
      cores = 0,
      patienceNanos,
      slowNanos
    )

  /** A block with its workers, and since when each has it. */
  final case class Lease(block: Block, holders: Map[String, Long]):
    private[blocks] def place: (Long, Long) = (holders.values.min, block.number)

  /** @param accepted number of blocks whose first answer was received
    * @param repeated number of answers that were not the first
    * @param doubled number of blocks assigned again because nothing else waited
    * @param lost number of blocks that had to wait again because their worker was lost
    * @param overdue number of blocks that waited again because no answer arrived in time
    */
  final case class Counts(accepted: Long, repeated: Long, doubled: Long, lost: Long, overdue: Long)

/** A worker's assignments and work.
  *
  * @param holds numbers of its assigned blocks, with the time of assignment or of its last mention
  * @param busyNanos time of computing, over all its answers
  */
final case class WorkerRecord(
    cores: Int,
    isHere: Boolean = true,
    holds: Map[Long, Long] = Map.empty,
    accepted: Long = 0,
    repeated: Long = 0,
    busyNanos: Long = 0
)
