package skein.cluster

import org.apache.pekko.actor.typed.ActorRef
import scala.collection.immutable.ArraySeq
import skein.cluster.jars.Sha256

/** What workers say. Any message may come late, twice or never.
  *
  * `run` names a coordinator's life: what was said in an earlier one means nothing. `worker` names a process,
  * and `number` a block of the run.
  */
private[cluster] enum ToCoordinator:
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
  )

  case Done(run: Long, worker: String, number: Long, busyNanos: Long, answer: ArraySeq[Byte])

  /** A block cannot be computed: nobody could. */
  case Failed(run: Long, worker: String, number: Long, reason: String)

  /** This worker cannot answer the run's question, or does not run its program. */
  case Unable(run: Long, worker: String, reason: String)

  /** A worker wants bytes of the program that it was offered: of its text or of one of its jars, from an
    * offset on.
    */
  case Fetch(worker: String, content: Sha256, offset: Long, replyTo: ActorRef[ToWorker])

/** What the coordinator says. */
private[cluster] enum ToWorker:
  case Welcome(run: Long, question: ArraySeq[Byte])
  case Give(run: Long, number: Long, work: ArraySeq[Byte])

  /** Its build is another. */
  case Refused(reason: String)

  /** Its build is another, and it may have the coordinator's. */
  case Offered(run: Long, reason: String, program: Sha256)

  /** Of the coordinator's program, as it was asked for; empty where there are no such bytes. */
  case Piece(content: Sha256, offset: Long, bytes: ArraySeq[Byte])

  /** All is done. */
  case Goodbye
