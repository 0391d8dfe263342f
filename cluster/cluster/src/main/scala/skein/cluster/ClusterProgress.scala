package skein.cluster

import skein.blocks.Coordinator

/** The progress of a coordinator's work.
  *
  * @param done number of blocks of the current call that have their answers
  * @param of total number of blocks of that call
  * @param resumed number of blocks, in all calls, whose answers were already in the ledger
  * @param died number of times that a worker was lost
  */
final case class ClusterProgress(
    coordinator: Coordinator = Coordinator(),
    done: Int = 0,
    of: Int = 0,
    resumed: Long = 0,
    died: Int = 0
):
  def here: Int = coordinator.workers.values.count(_.isHere)

/** A change of a worker's state, with a line for the user. */
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
