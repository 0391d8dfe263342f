package skein.cluster

import skein.blocks.Coordinator

/** Where a coordinator's work stands.
  *
  * @param done blocks of the call under way that have their answers
  * @param of all blocks of that call
  * @param resumed blocks, of all calls, whose answers were in the ledger already
  * @param died how often a worker was lost
  * @param traffic messages since the start
  * @param ledgerBytes of the file
  */
final case class ClusterProgress(
    coordinator: Coordinator = Coordinator(),
    done: Int = 0,
    of: Int = 0,
    resumed: Long = 0,
    died: Int = 0,
    traffic: Traffic = Traffic(),
    ledgerBytes: Long = 0
):
  def here: Int = coordinator.workers.values.count(_.isHere)

/** How many messages of each kind a coordinator heard and said. */
final case class Traffic(heard: Map[String, Long] = Map.empty, said: Map[String, Long] = Map.empty):
  private[cluster] def hearing(message: ToCoordinator): Traffic =
    copy(heard = Traffic.counted(heard, message.productPrefix))

  private[cluster] def saying(message: ToWorker): Traffic =
    copy(said = Traffic.counted(said, message.productPrefix))

object Traffic:
  private def counted(counts: Map[String, Long], kind: String) =
    counts.updated(kind, counts.getOrElse(kind, 0L) + 1)

/** What a coordinator tells of its workers, in a line for a person. */
enum WorkerEvent(val text: String):
  case Joined(worker: String, cores: Int)
      extends WorkerEvent(s"$worker joined, with $cores ${if cores == 1 then "core" else "cores"}")
  case Lost(worker: String, blocks: Int)
      extends WorkerEvent(s"$worker is gone; $blocks blocks that it had wait again")
  case Refused(worker: String, reason: String) extends WorkerEvent(s"refused $worker: $reason")
  case NotTrusted(reason: String)
      extends WorkerEvent(
        s"somebody is not trusted here, or does not trust this side: $reason"
      )
