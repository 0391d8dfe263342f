package skein.cluster

import java.security.SecureRandom
import java.util.concurrent.atomic.AtomicReference
import java.util.concurrent.{CompletableFuture, TimeUnit}
import org.apache.pekko.actor.typed.scaladsl.Behaviors
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.actor.typed.{ActorRef, Behavior}
import org.apache.pekko.actor.{ActorSystem, Address as NodeAddress, ExtendedActorSystem}
import org.apache.pekko.cluster.ClusterEvent.{
  MemberEvent,
  MemberRemoved,
  ReachabilityEvent,
  UnreachableMember
}
import org.apache.pekko.cluster.typed.{Cluster, Down, Join, Subscribe}
import scala.collection.immutable.ArraySeq
import scala.concurrent.duration.DurationInt
import scala.concurrent.ExecutionContext.parasitic
import scala.concurrent.{Await, ExecutionContext, Future, Promise}
import scala.util.control.NonFatal
import skein.blocks.Ledger
import skein.link.Address

/** The process that assigns blocks and stores their answers. */
final class CoordinatorNode private (
    system: ActorSystem,
    coordinator: ActorRef[CoordinatorBehavior.Command],
    latest: AtomicReference[ClusterProgress]
):
  import CoordinatorNode.MostClosing

  val address: Address =
    val own = CoordinatorNode.addressOf(system)
    Address(own.host.get.stripPrefix("[").stripSuffix("]"), own.port.get)

  def progress: ClusterProgress = latest.get

  /** Lets all workers that are or become members compute the works. Works with answers in the ledger are not
    * computed again. One call at a time.
    *
    * @param onAnswer called with each answer when it arrives or is found in the ledger, in any order, on a
    *   thread of the node's own
    * @param onWanted called on such a thread if the ledger lacks answers
    * @return the answers in the order of the works; None if it was cancelled; Left says why there are none
    */
  def compute(
      works: Vector[ArraySeq[Byte]],
      onAnswer: ArraySeq[Byte] => Unit = _ => (),
      onWanted: () => Unit = () => ()
  ): Future[Either[String, Option[Vector[ArraySeq[Byte]]]]] =
    val promise = Promise[CoordinatorBehavior.Outcome]()
    coordinator ! CoordinatorBehavior.Compute(works, onAnswer, onWanted, promise)
    promise.future

  def cancel(): Unit = coordinator ! CoordinatorBehavior.Cancel

  /** Informs the coordinator that a worker's process has ended. */
  def ended(worker: String): Unit = coordinator ! CoordinatorBehavior.Ended(worker)

  /** Sends the workers a farewell and ends, waiting no longer than [[MostClosing]]; the ledger is not closed.
    */
  def close(): Future[Unit] =
    coordinator ! CoordinatorBehavior.Farewell
    val late    = CompletableFuture.delayedExecutor(MostClosing.toSeconds, TimeUnit.SECONDS)
    val waiting = Future.unit.map(identity)(using ExecutionContext.fromExecutor(late))
    Future.firstCompletedOf(Seq(system.terminate(), waiting))(using parasitic).map(_ => ())(using parasitic)

  /** Ends without a farewell, as if killed; for tests. */
  private[cluster] def kill(): Unit =
    val _ = Await.result(system.terminate(), 30.seconds)

object CoordinatorNode:
  private[cluster] val Name = "coordinator"

  /** Time limit of closing: Pekko's remoting waits without a limit for its peers' streams to end
    * (apache/pekko#3247).
    */
  private val MostClosing = 20.seconds

  /** @param listen the endpoint to listen at; port 0 for any that is free
    * @param ledger the question's ledger
    * @param tell called with the workers' changes, on a thread of the node's own
    * @return Left says why it cannot listen
    */
  def start(
      listen: Address,
      tls: Option[Tls],
      question: ArraySeq[Byte],
      ledger: Ledger,
      build: String = BuildId.current
  )(tell: WorkerEvent => Unit): Either[String, CoordinatorNode] =
    for
      _ <- Either.cond(
        question.length <= MessageCodec.MostBytes,
        (),
        s"the question has ${question.length} bytes, expected at most ${MessageCodec.MostBytes}"
      )
      config <- NodeConfig.of(listen, tls)
      system <-
        try Right(ActorSystem(NodeConfig.System, config))
        catch case NonFatal(failed) => Left(s"cannot listen at $listen: ${reason(failed)}")
    yield
      val latest  = AtomicReference(ClusterProgress())
      val job     = Job(SecureRandom().nextLong() | 1, build, question)
      val manager = Cluster(system.toTyped).manager
      val actor   =
        system.spawn(CoordinatorBehavior(job, ledger, tell, latest.set, manager ! Down(_)), Name)
      val _ = system.eventStream.subscribe(actor.toClassic, classOf[CoordinatorBehavior.NotTrusted])
      val _ = system.spawn(watching(actor), "members")
      manager ! Join(addressOf(system))
      CoordinatorNode(system, actor, latest)

  private[cluster] def addressOf(system: ActorSystem): NodeAddress =
    system.asInstanceOf[ExtendedActorSystem].provider.getDefaultAddress

  private def reason(failed: Throwable): String =
    Iterator.iterate(failed)(
      _.getCause
    ).takeWhile(_ != null).map(_.getMessage).filter(_ != null).toVector.last

  /** Forwards unreachable and removed members to the coordinator. */
  private def watching(coordinator: ActorRef[CoordinatorBehavior.Command])
      : Behavior[MemberEvent | ReachabilityEvent] =
    Behaviors.setup: context =>
      val events = Cluster(context.system).subscriptions
      events ! Subscribe(context.self, classOf[MemberEvent])
      events ! Subscribe(context.self, classOf[ReachabilityEvent])
      Behaviors.receiveMessage: event =>
        event match
          case UnreachableMember(member) => coordinator ! CoordinatorBehavior.Unreachable(member.address)
          case MemberRemoved(member, _)  => coordinator ! CoordinatorBehavior.Removed(member.address)
          case _                         => ()
        Behaviors.same
