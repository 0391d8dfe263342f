package skein.cluster

import java.io.IOException
import org.apache.pekko.actor.Address
import org.apache.pekko.actor.typed.scaladsl.{AbstractBehavior, ActorContext, Behaviors, TimerScheduler}
import org.apache.pekko.actor.typed.{ActorRef, Behavior}
import scala.collection.immutable.ArraySeq
import scala.collection.mutable
import scala.concurrent.Promise
import scala.concurrent.duration.DurationInt
import skein.blocks.{Block, BlockKey, Coordinator, Ledger}

/** A coordinator's question.
  *
  * @param run identifies this run of the coordinator; not 0
  * @param build the [[BuildId]] that workers must have
  */
private[cluster] final case class Job(run: Long, build: String, question: ArraySeq[Byte])

/** The actor around a [[Coordinator]], which makes the decisions. The actor receives workers' messages,
  * stores answers and reports progress. One call at a time.
  *
  * @param onProgress called after every change
  * @param down removes a process that has ended or is unreachable from the cluster: until then no other
  *   process becomes a member. A process that was still alive joins again
  */
private[cluster] final class CoordinatorBehavior private (
    context: ActorContext[CoordinatorBehavior.Command],
    job: Job,
    ledger: Ledger,
    tell: WorkerEvent => Unit,
    onProgress: ClusterProgress => Unit,
    down: Address => Unit
) extends AbstractBehavior[CoordinatorBehavior.Command](context):
  import CoordinatorBehavior.*

  private var state   = Coordinator(slowNanos = Slow)
  private var next    = 0L
  private var call    = Option.empty[Call]
  private var resumed = 0L
  private var died    = 0
  private var unsaved = false
  private var isDone  = false

  /** The actors to which messages for each worker go; includes workers that have only received the question.
    */
  private var addresses = Map.empty[String, ActorRef[ToWorker]]

  /** Workers with free cores for which there was no block. */
  private var hungry = Set.empty[String]

  private var told = Set.empty[WorkerEvent]

  def onMessage(command: Command): Behavior[Command] =
    command match
      case ask: Message.Ask                                    => asked(ask)
      case Message.Done(job.run, worker, number, busy, answer) => answered(worker, number, busy, answer)
      case Message.Failed(job.run, worker, number, reason)     =>
        ended(Left(s"a block cannot be computed, as $worker reports: $reason"))
      case Message.Unable(job.run, worker, reason) => once(WorkerEvent.Refused(worker, reason))
      case _: ToCoordinator                        => () // A message of an earlier run.
      case asked: Compute                          => compute(asked)
      case Cancel                                  =>
        state = state.cancelled
        ended(Right(None))
      case Unreachable(address) =>
        down(address)
        lostAt(address)
      case Removed(address) => lostAt(address)
      case Ended(worker)    =>
        addresses.get(worker).foreach(one => down(one.path.address))
        lost(worker)
      case Tick =>
        state = state.at(System.nanoTime())
        feed()
        save()
      case NotTrusted(reason) => once(WorkerEvent.NotTrusted(reason))
      case Farewell           =>
        // Stays until the node ends: some workers may send their first request only now.
        isDone = true
        addresses.values.foreach(_ ! Message.Goodbye)
        save()
        ended(Right(None))
    publish()
    this

  private def asked(ask: Message.Ask): Unit =
    if ask.build != job.build then
      val reason = s"its build is ${ask.build}, expected the coordinator's, ${job.build}"
      ask.replyTo ! Message.Refused(reason)
      once(WorkerEvent.Refused(ask.worker, reason))
    else if isDone then ask.replyTo ! Message.Goodbye
    else
      addresses += ask.worker -> ask.replyTo
      if ask.run != job.run then ask.replyTo ! Message.Welcome(job.run, job.question)
      else
        val isNew = !state.workers.get(ask.worker).exists(_.isHere)
        state = state.joined(ask.worker, ask.cores)
        if isNew then announce(WorkerEvent.Joined(ask.worker, ask.cores))
        serve(ask.worker, ask.holding)

  private def once(news: WorkerEvent): Unit =
    if !told(news) && told.size < MostTold then
      told += news
      tell(news)

  private def serve(worker: String, holding: Set[Long]): Unit =
    val (after, block) = state.asked(worker, holding, System.nanoTime())
    state = after
    block match
      case Some(one) =>
        addresses(worker) ! Message.Give(job.run, one.number, one.work)
        serve(worker, holding + one.number)
      case None =>
        val record = state.workers(worker)
        if record.holds.size < record.cores then hungry += worker else hungry -= worker

  private def feed(): Unit =
    if state.waiting.nonEmpty then
      for worker <- hungry do serve(worker, state.workers(worker).holds.keySet)

  private def answered(worker: String, number: Long, busyNanos: Long, answer: ArraySeq[Byte]): Unit =
    val (after, first) = state.answered(worker, number, busyNanos)
    state = after
    first.foreach: block =>
      keep(block.key, answer) match
        case Left(mistake) => ended(Left(mistake))
        case Right(())     =>
          call.foreach: open =>
            open.take(block.key, answer)
            if open.isDone then ended(Right(Some(open.all)))

  private def keep(key: BlockKey, answer: ArraySeq[Byte]): Either[String, Unit] =
    try
      unsaved |= ledger.accept(key, answer)
      Right(())
    catch case failed: IOException => Left(s"cannot write the ledger of blocks: $failed")

  private def save(): Unit = if unsaved then
    try ledger.force()
    catch case failed: IOException => ended(Left(s"cannot write the ledger of blocks: $failed"))
    unsaved = false

  private def lostAt(address: Address): Unit =
    addresses.keys.filter(worker => addresses(worker).path.address == address).foreach(lost)

  private def lost(worker: String): Unit =
    addresses -= worker
    // Workers that leave when all is done have been dismissed.
    if !isDone then
      state.workers.get(worker).filter(_.isHere).foreach: record =>
        died += 1
        state = state.lost(worker)
        announce(WorkerEvent.Lost(worker, record.holds.size))
        feed()

  private def compute(asked: Compute): Unit =
    import asked.*
    if isDone then promise.success(Right(None))
    else if call.isDefined then promise.success(Left("one call at a time"))
    else
      val open = Call(works.map(BlockKey.of), onAnswer, promise)
      val asks = works.zip(open.keys).distinctBy(_._2).filter: (_, key) =>
        val known = ledger.answer(key)
        known.foreach(open.take(key, _))
        known.isEmpty
      resumed += open.answers.size
      call = Some(open)
      val blocks = asks.map: (work, _) =>
        next += 1
        Block(next, work)
      state = state.offered(blocks)
      if open.isDone then ended(Right(Some(open.all)))
      else
        onWanted()
        feed()

  /** Completes the call. A failure drops its remaining blocks. */
  private def ended(outcome: Outcome): Unit =
    if outcome.isLeft then state = state.cancelled
    // The receiver of the outcome sees the complete progress.
    publish()
    call.foreach(_.promise.trySuccess(outcome))
    call = None

  /** Reports a change after publishing the progress, so that the receiver sees the change there. */
  private def announce(change: WorkerEvent): Unit =
    publish()
    tell(change)

  private def publish(): Unit =
    onProgress(ClusterProgress(
      state,
      call.fold(0)(_.answers.size),
      call.fold(0)(_.asked),
      resumed,
      died
    ))

private[cluster] object CoordinatorBehavior:
  /** All answers in the order of the works; None if it was cancelled; Left says why there are none. */
  type Outcome = Either[String, Option[Vector[ArraySeq[Byte]]]]

  sealed trait Local
  final case class Compute(
      works: Vector[ArraySeq[Byte]],
      onAnswer: ArraySeq[Byte] => Unit,
      onWanted: () => Unit,
      promise: Promise[Outcome]
  ) extends Local
  case object Cancel                             extends Local
  final case class Unreachable(address: Address) extends Local

  /** The process at this address has left the cluster; another may use the address. */
  final case class Removed(address: Address) extends Local

  final case class Ended(worker: String) extends Local
  case object Farewell                   extends Local

  final case class NotTrusted(reason: String) extends Local
  private case object Tick                    extends Local

  type Command = ToCoordinator | Local

  /** Maximum number of changes that are remembered, so that each is reported only once. */
  private val MostTold = 1000

  /** Age from which a block goes to a second worker, when nothing else waits. */
  private val Slow = 1_000_000_000L

  private final case class Call(
      keys: Vector[BlockKey],
      onAnswer: ArraySeq[Byte] => Unit,
      promise: Promise[Outcome]
  ):
    val answers = mutable.HashMap.empty[BlockKey, ArraySeq[Byte]]

    def take(key: BlockKey, answer: ArraySeq[Byte]): Unit =
      answers.update(key, answer)
      onAnswer(answer)

    val asked: Int                  = keys.toSet.size
    def isDone: Boolean             = answers.size == asked
    def all: Vector[ArraySeq[Byte]] = keys.map(answers)

  def apply(
      job: Job,
      ledger: Ledger,
      tell: WorkerEvent => Unit,
      onProgress: ClusterProgress => Unit,
      down: Address => Unit
  ): Behavior[Command] =
    Behaviors.withTimers: (timers: TimerScheduler[Command]) =>
      timers.startTimerWithFixedDelay(Tick, 1.second)
      Behaviors.setup(context => new CoordinatorBehavior(context, job, ledger, tell, onProgress, down))
