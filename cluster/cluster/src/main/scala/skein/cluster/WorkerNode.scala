package skein.cluster

import com.typesafe.config.Config
import java.net.InetAddress
import java.util.concurrent.{ExecutorService, Executors, TimeUnit, TimeoutException}
import org.apache.pekko.actor.typed.scaladsl.Behaviors
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.actor.typed.{ActorRef, ActorRefResolver, Behavior}
import org.apache.pekko.actor.{ActorSystem, Address as NodeAddress}
import org.apache.pekko.cluster.ClusterEvent.{
  MemberEvent,
  MemberRemoved,
  ReachabilityEvent,
  UnreachableMember
}
import org.apache.pekko.cluster.typed.{Cluster, JoinSeedNodes, SelfUp, Subscribe}
import scala.concurrent.duration.{Duration, DurationLong, FiniteDuration}
import scala.concurrent.{Await, Promise}
import scala.util.Try
import scala.util.control.NonFatal
import skein.cluster.WorkerBehavior.End
import skein.link.{Address, TlsProbe}

/** A process that computes blocks.
  *
  * @param patience time for which it tries to reach a coordinator that it has not reached yet, or has lost
  * @param tell called with progress, in lines for the user
  */
final class WorkerNode(
    coordinator: Address,
    listen: Address,
    tls: Option[Tls],
    cores: Int,
    solvers: BlockSolverFactory,
    patience: FiniteDuration,
    name: String = WorkerNode.nameOf(ProcessHandle.current().pid()),
    build: String = BuildId.current
)(tell: String => Unit):
  require(
    cores >= 1 && cores <= MessageCodec.MostCores,
    s"cores: expected 1 to ${MessageCodec.MostCores}, got $cores"
  )

  @volatile private var stopped = false
  @volatile private var ending  = Promise[End]()

  /** Time at which the worker was last a member, or began to connect. */
  @volatile private var contactAt = 0L

  def stop(): Unit =
    stopped = true
    val _ = ending.trySuccess(End.Finished)

  /** Computes until the coordinator has no more work. Blocks the calling thread.
    *
    * @return Left says why it could not
    */
  def run(): Either[String, Unit] =
    NodeConfig.of(listen, tls, joins = Some(coordinator)).flatMap: config =>
      val pool = Executors.newFixedThreadPool(cores, WorkerNode.thread(_))
      val self = WorkerBehavior.Self(name, cores, build, solvers, System.nanoTime())
      try
        tell(s"$name, $cores ${if cores == 1 then "core" else "cores"}, build $build: joining $coordinator")
        contactAt = self.startedAt
        var outcome = Option.empty[Either[String, Unit]]
        while outcome.isEmpty do
          val how    = once(config, self, pool)
          val waited = System.nanoTime() - contactAt
          outcome = how match
            case _ if stopped =>
              tell("dismissed by the coordinator")
              Some(Right(()))
            case End.Finished =>
              tell("the work is done: the coordinator has all answers")
              Some(Right(()))
            case End.Refused(reason)            => Some(Left(reason))
            case _ if waited > patience.toNanos =>
              val why = refusal.fold("")("; " + _)
              Some(Left(s"no coordinator at $coordinator for ${patience.toSeconds} s$why"))
            case _ =>
              val left = (patience.toNanos - waited) / 1_000_000_000
              tell(s"cannot reach the coordinator at $coordinator; joining again, for $left s at most")
              None
        outcome.get
      catch case NonFatal(failed) => Left(s"cannot listen at $listen: ${failed.getMessage}")
      finally pool.shutdownNow(): Unit

  /** The reason why the coordinator refuses this worker; None if certificates are not the reason. */
  private def refusal: Option[String] = tls match
    case Some(own) => own.refusal(coordinator)
    case None      =>
      Option.when(TlsProbe.answers(coordinator)):
        "who listens there asks for certificates: expected --tls FOLDER with this machine's"

  private def once(config: Config, self: WorkerBehavior.Self, pool: ExecutorService): End =
    val promise            = Promise[End]()
    @volatile var isMember = false
    ending = promise
    if stopped then promise.trySuccess(End.Finished): Unit
    val system = ActorSystem(NodeConfig.System, config)
    try
      val seed = NodeAddress("pekko", NodeConfig.System, coordinator.uriHost, coordinator.port)
      system.whenTerminated.onComplete(_ => promise.trySuccess(End.Lost))(using
        scala.concurrent.ExecutionContext.parasitic
      )
      val to =
        ActorRefResolver(system.toTyped).resolveActorRef[ToCoordinator](s"$seed/user/${CoordinatorNode.Name}")
      val work =
        system.spawn(
          WorkerBehavior(to, self, pool, tell, end => { val _ = promise.trySuccess(end) }),
          "worker"
        )
      val _ = system.spawn(
        WorkerNode.member(seed, work, () => { isMember = true; tell(s"joined $coordinator, ${self.age}") }),
        "member"
      )
      val left = patience.toNanos - (System.nanoTime() - contactAt)
      val how  = WorkerNode.within(left)(promise).getOrElse:
        if isMember then Await.result(promise.future, Duration.Inf) else End.Lost
      if isMember then contactAt = System.nanoTime()
      how
    finally
      val _ = Try(Await.result(system.terminate(), Duration(10, TimeUnit.SECONDS)))

object WorkerNode:
  def nameOf(pid: Long): String = s"$host-$pid"

  private lazy val host: String = Try(InetAddress.getLocalHost.getHostName).getOrElse("localhost")

  private def thread(body: Runnable): Thread =
    val made = Thread(body, "blocks")
    made.setDaemon(true)
    made

  /** The promise's value, if it completes within this time. */
  private def within[A](nanos: Long)(promise: Promise[A]): Option[A] =
    try Some(Await.result(promise.future, nanos.max(0).nanos))
    catch case _: TimeoutException => None

  /** Whether an event says that the member at an address has left, or cannot be reached. */
  private[cluster] def isLost(address: NodeAddress, event: Any): Boolean = event match
    case UnreachableMember(member) => member.address == address
    case MemberRemoved(member, _)  => member.address == address
    case _                         => false

  /** Joins the cluster. Reports membership and loss of the coordinator to `work`. */
  private def member(
      seed: NodeAddress,
      work: ActorRef[WorkerBehavior.Command],
      onUp: () => Unit
  ): Behavior[SelfUp | MemberEvent | ReachabilityEvent] =
    Behaviors.setup: context =>
      val cluster = Cluster(context.system)
      cluster.subscriptions ! Subscribe(context.self, classOf[SelfUp])
      cluster.subscriptions ! Subscribe(context.self, classOf[MemberEvent])
      cluster.subscriptions ! Subscribe(context.self, classOf[ReachabilityEvent])
      cluster.manager ! JoinSeedNodes(Vector(seed))
      Behaviors.receiveMessage: event =>
        event match
          case _: SelfUp =>
            onUp()
            work ! WorkerBehavior.Member
          case change => if isLost(seed, change) then work ! WorkerBehavior.Unreachable
        Behaviors.same
