package skein.cluster

import org.apache.pekko.actor.typed.ActorRef
import scala.collection.immutable.ArraySeq

/** What workers say. Any message may come late, twice or never. */
private[cluster] sealed trait ToCoordinator extends Product

/** What the coordinator says. */
private[cluster] sealed trait ToWorker extends Product

/** `run` names a coordinator's life: what was said in an earlier one means nothing. `worker` names a process,
  * and `number` a block of the run. Their order is that of [[MessageCodec]]'s kinds.
  */
private[cluster] enum Message:
  /** A worker has room for blocks. Said once a second at least.
    *
    * @param run 0 before it is known
    * @param build see [[BuildId]]
    * @param holding the blocks that it has
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

  /** A block that no worker can compute. */
  case Failed(run: Long, worker: String, number: Long, reason: String) extends Message, ToCoordinator

  /** This worker cannot answer the run's question. */
  case Unable(run: Long, worker: String, reason: String) extends Message, ToCoordinator

  case Welcome(run: Long, question: ArraySeq[Byte])        extends Message, ToWorker
  case Give(run: Long, number: Long, work: ArraySeq[Byte]) extends Message, ToWorker

  case Refused(reason: String) extends Message, ToWorker

  case Goodbye extends Message, ToWorker
