package skein.cluster

import skein.blocks.Coordinator

/** Where a coordinator's work stands.
  *
  * @param done
  *   blocks of the call under way that have their answers
  * @param of
  *   all blocks of that call
  * @param resumed
  *   blocks, of all calls, whose answers were in the ledger already
  * @param died
  *   how often a worker was lost
  */
final case class Progress(coordinator: Coordinator, done: Int, of: Int, resumed: Long, died: Int):
  def here: Int = coordinator.workers.values.count(_.isHere)

/** What a coordinator tells of its workers, in a line for a person. */
enum News(val text: String):
  case Joined(worker: String, cores: Int)
      extends News(s"$worker joined, with $cores ${if cores == 1 then "core" else "cores"}")
  case Lost(worker: String, blocks: Int)
      extends News(s"$worker is gone; $blocks blocks that it had wait again")
  case Refused(worker: String, reason: String) extends News(s"refused $worker: $reason")
