package skein.cluster

import java.util.concurrent.{ArrayBlockingQueue, ExecutorService}
import org.apache.pekko.actor.typed.scaladsl.{AbstractBehavior, ActorContext, Behaviors, TimerScheduler}
import org.apache.pekko.actor.typed.{ActorRef, Behavior}
import scala.collection.immutable.ArraySeq
import scala.concurrent.duration.DurationInt
import scala.util.control.NonFatal
import skein.units.Decimals.fixed

/** Requests blocks from the coordinator, has them computed by a pool of threads, and answers. It requests the
  * question before it is a member of the cluster, but blocks only as a member: the loss of any other process
  * would go unnoticed.
  *
  * @param pool threads that compute, as many as cores
  * @param tell called with progress, in lines for the user
  * @param onEnd called with the reason for the end
  */
private[cluster] final class WorkerBehavior private (
    context: ActorContext[WorkerBehavior.Command],
    coordinator: ActorRef[ToCoordinator],
    self: WorkerBehavior.Self,
    pool: ExecutorService,
    tell: String => Unit,
    onEnd: WorkerBehavior.End => Unit
) extends AbstractBehavior[WorkerBehavior.Command](context):
  import WorkerBehavior.*

  private var run     = 0L
  private var solvers = Option.empty[ArrayBlockingQueue[BlockSolver]]
  private var member  = false
  private var held    = Set.empty[Long]
  private var begun   = 0L
  private var blocks  = 0L
  private var busy    = 0L
  private var beats   = 0

  def onMessage(command: Command): Behavior[Command] = command match
    case Beat =>
      beats += 1
      if run == 0 then ask() else askIfReady()
      if beats % BeatsAReport == 0 && blocks > 0 then tell(summary)
      this
    case Member =>
      member = true
      askIfReady()
      this
    case Message.Welcome(welcome, question) =>
      if welcome != run then
        run = welcome
        solvers = None
        held = Set.empty
        tell("received the question from the coordinator")
        inPool(prepared(question))((made, _) => Prepared(welcome, made))
      this
    case Prepared(of, made) if of == run =>
      made match
        case Right(ready) =>
          solvers = Some(ready)
          askIfReady()
          this
        case Left(reason) =>
          coordinator ! Message.Unable(run, self.name, reason)
          end(End.Refused(s"cannot answer the coordinator's question: $reason"))
    case Message.Give(of, number, work) if of == run && !held(number) && held.size < MessageCodec.MostHeld =>
      solvers.foreach: ready =>
        if begun == 0 then tell(s"computes its first block, ${self.age}")
        begun += 1
        held += number
        inPool(solved(work, ready))(Solved(of, number, _, _))
      this
    case Solved(of, number, answer, nanos) if of == run =>
      held -= number
      answer match
        case Right(bytes) =>
          blocks += 1
          busy += nanos
          coordinator ! Message.Done(run, self.name, number, nanos, bytes)
        case Left(reason) => coordinator ! Message.Failed(run, self.name, number, reason)
      ask()
      this
    case Message.Refused(reason) => end(End.Refused(reason))
    case Message.Goodbye         => end(End.Finished)
    case Unreachable             => end(End.Lost)
    case _                       => this // A block of an earlier run, or one that it already has.

  private def askIfReady(): Unit = if member && solvers.isDefined then ask()

  private def ask(): Unit =
    coordinator ! Message.Ask(self.name, self.cores, self.build, run, held, context.self)

  private def end(how: End): Behavior[Command] =
    if blocks > 0 then tell(summary)
    onEnd(how)
    Behaviors.stopped

  private def summary =
    s"$blocks ${if blocks == 1 then "block" else "blocks"} computed in ${(busy * 1e-9).fixed(1)} s of its cores"

  /** Computes in the pool. Every failure is an answer, or the coordinator would wait for a block that is
    * lost; a fatal one ends its thread as well.
    */
  private def inPool[A](compute: => Either[String, A])(message: (Either[String, A], Long) => Command): Unit =
    val me = context.self
    pool.execute: () =>
      val from                          = System.nanoTime()
      def answer(of: Either[String, A]) = me ! message(of, System.nanoTime() - from)
      try answer(compute)
      catch
        case _: InterruptedException => answer(Left("the worker ends"))
        case failed: Throwable       =>
          answer(Left(failed.toString))
          if !NonFatal(failed) then throw failed

  private def prepared(question: ArraySeq[Byte]): Either[String, ArrayBlockingQueue[BlockSolver]] =
    self.solvers.of(question).map: make =>
      val ready = ArrayBlockingQueue[BlockSolver](self.cores)
      for _ <- 0 until self.cores do ready.put(make())
      ready

  private def solved(work: ArraySeq[Byte], ready: ArrayBlockingQueue[BlockSolver]) =
    // There are as many solvers as threads, so one is always free.
    val solver = ready.take()
    try Right(solver.solve(work))
    finally ready.put(solver)

private[cluster] object WorkerBehavior:
  final case class Self(
      name: String,
      cores: Int,
      build: String,
      solvers: BlockSolverFactory,
      startedAt: Long
  ):
    /** The time since the block's start, for the user; it started at `startedAt` by `System.nanoTime`. */
    def age: String = s"${((System.nanoTime() - startedAt) * 1e-9).fixed(1)} s after its start"

  enum End:
    case Finished, Lost
    case Refused(reason: String)

  sealed trait Local
  case object Beat extends Local
  private final case class Prepared(run: Long, made: Either[String, ArrayBlockingQueue[BlockSolver]])
      extends Local
  private final case class Solved(
      run: Long,
      number: Long,
      answer: Either[String, ArraySeq[Byte]],
      nanos: Long
  ) extends Local

  case object Member extends Local

  case object Unreachable extends Local

  type Command = ToWorker | Local

  private val BeatsAReport = 10

  def apply(
      coordinator: ActorRef[ToCoordinator],
      self: Self,
      pool: ExecutorService,
      tell: String => Unit,
      onEnd: End => Unit
  ): Behavior[Command] =
    Behaviors.withTimers: (timers: TimerScheduler[Command]) =>
      timers.startTimerWithFixedDelay(Beat, 0.seconds, 1.second)
      Behaviors.setup(context => new WorkerBehavior(context, coordinator, self, pool, tell, onEnd))
