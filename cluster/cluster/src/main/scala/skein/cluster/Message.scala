package skein.cluster

import org.apache.pekko.actor.typed.ActorRef
import scala.collection.immutable.ArraySeq

/** Workers' messages. Any message may arrive late, twice or never. */
private[cluster] sealed trait ToCoordinator extends Product

/** Messages from the coordinator to a worker. */
private[cluster] sealed trait ToWorker extends Product

/** Messages between coordinator and workers. `run` identifies a coordinator's run: messages of an earlier one
  * are ignored. `worker` identifies a process, and `number` a block of the run. Their order is that of
  * [[MessageCodec]]'s kinds.
  */
private[cluster] enum Message:
  /** A worker has room for blocks. Sent at least once a second.
    *
    * @param run the coordinator's run; 0 before it is known
    * @param build see [[BuildId]]
    * @param holding numbers of the blocks that it has
    */
  case Ask(
      worker: String,
      cores: Int,
      build: String,
      run: Long,
      holding: Set[Long],
      replyTo: ActorRef[ToWorker]
  ) extends Message, ToCoordinator

  case Done(run: Long, worker: String, number: Long, busyNanos: Long, answer: ArraySeq[Byte])
      extends Message, ToCoordinator

  /** No worker can compute the block, for this reason. */
  case Failed(run: Long, worker: String, number: Long, reason: String) extends Message, ToCoordinator

  /** This worker cannot answer the run's question. */
  case Unable(run: Long, worker: String, reason: String) extends Message, ToCoordinator

  case Welcome(run: Long, question: ArraySeq[Byte])        extends Message, ToWorker
  case Give(run: Long, number: Long, work: ArraySeq[Byte]) extends Message, ToWorker

  case Refused(reason: String) extends Message, ToWorker

  case Goodbye extends Message, ToWorker
