package skein.cluster

import java.util.concurrent.atomic.AtomicReference
import java.util.concurrent.{ConcurrentLinkedQueue, Executors, LinkedBlockingQueue, TimeUnit}
import org.apache.pekko.actor.{ActorSystem, Address}
import org.apache.pekko.actor.typed.scaladsl.Behaviors
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.cluster.ClusterEvent.{MemberRemoved, ReachableMember, UnreachableMember}
import org.apache.pekko.cluster.MemberStatus
import org.apache.pekko.cluster.typed.Cluster
import scala.collection.immutable.ArraySeq
import scala.concurrent.{Await, Promise}
import scala.concurrent.duration.DurationInt
import scala.jdk.CollectionConverters.*
import skein.blocks.{Coordinator, Ledger}
import skein.testing.TemporaryFolders

/** Coordinator and worker, each tested alone, with its messages in a queue. */
class BehaviorsSuite extends munit.FunSuite, TemporaryFolders:

  private val question = ArraySeq[Byte](1, 2, 3)
  private val pool     = Executors.newFixedThreadPool(1)

  private lazy val system = ActorSystem("behaviors")

  override def afterAll(): Unit =
    pool.shutdownNow()
    Await.result(system.terminate(), 30.seconds): Unit

  private final class Heard[A]:
    private val queue = LinkedBlockingQueue[A]()
    val actor         = system.spawnAnonymous(Behaviors.receiveMessage[A] { message =>
      queue.add(message)
      Behaviors.same
    })
    def said: Vector[A] = queue.asScala.toVector
    def next(): A       = Option(queue.poll(30, TimeUnit.SECONDS)).getOrElse(fail("nothing was said"))

  private def run(asked: ToCoordinator) = asked match
    case ask: Message.Ask => ask.run
    case other            => fail(s"expected an Ask, got $other")

  test("a worker prepares its question before it is a member, and requests blocks once it is"):
    val heard  = Heard[ToCoordinator]()
    val told   = ConcurrentLinkedQueue[String]()
    val ready  = LinkedBlockingQueue[Int]()
    val solver = new BlockSolverFactory:
      def of(asked: ArraySeq[Byte]) = Right(() =>
        ready.add(1)
        work => work
      )
    val worker = system.spawnAnonymous(WorkerBehavior(
      heard.actor,
      WorkerBehavior.Self("anna", 1, "one", solver, System.nanoTime()),
      pool,
      told.add(_): Unit,
      _ => ()
    ))
    assertEquals(run(heard.next()), 0L)
    worker ! Message.Welcome(7, question)
    assert(ready.poll(30, TimeUnit.SECONDS) == 1, "was not made ready")
    assert(heard.said.forall(run(_) == 0), "asked for blocks")
    worker ! WorkerBehavior.Member
    assertEquals(Iterator.continually(run(heard.next())).dropWhile(_ == 0).next(), 7L)

  test("a worker computes each given block once, answers with its number, and limits the blocks it holds"):
    val heard  = Heard[ToCoordinator]()
    val begun  = LinkedBlockingQueue[Byte]()
    val goOn   = LinkedBlockingQueue[Unit]()
    val solver = new BlockSolverFactory:
      def of(asked: ArraySeq[Byte]) = Right(() =>
        work =>
          begun.add(work.head)
          goOn.take()
          if work.head == 3 then throw IllegalArgumentException("not three") else work :+ 9.toByte
      )
    val worker = system.spawnAnonymous(WorkerBehavior(
      heard.actor,
      WorkerBehavior.Self("anna", 1, "one", solver, System.nanoTime()),
      pool,
      _ => (),
      _ => ()
    ))
    def next[A](wanted: PartialFunction[ToCoordinator, A]): A =
      Iterator.continually(heard.next()).collectFirst(wanted).get
    worker ! WorkerBehavior.Member
    worker ! Message.Welcome(7, question)
    next { case ask: Message.Ask if ask.run == 7 => () }
    def give(number: Long, of: Long = 7) = worker ! Message.Give(of, number, ArraySeq(number.toByte))
    give(1)
    give(1)
    give(4, of = 6)
    give(2)
    goOn.add(())
    val (number, answer) =
      next { case Message.Done(7, "anna", number, busy, answer) if busy > 0 => (number, answer) }
    assertEquals((number, answer), (1L, ArraySeq[Byte](1, 9)))
    assertEquals(next { case ask: Message.Ask => ask.holding }, Set(2L))
    goOn.add(())
    assertEquals(
      next { case Message.Done(7, "anna", number, _, answer) => (number, answer) },
      (2L, ArraySeq[Byte](2, 9))
    )
    give(3)
    goOn.add(())
    assertEquals(
      next { case Message.Failed(7, "anna", number, reason) => (number, reason) },
      (3L, "java.lang.IllegalArgumentException: not three")
    )
    assertEquals(begun.asScala.toVector, Vector[Byte](1, 2, 3))

  test("a block whose computation overflows the stack is answered with the reason"):
    val heard  = Heard[ToCoordinator]()
    val solver = new BlockSolverFactory:
      def of(asked: ArraySeq[Byte]) = Right(() => _ => throw StackOverflowError("too deep"))
    val own    = Executors.newFixedThreadPool(1, silent(_))
    val worker = system.spawnAnonymous(WorkerBehavior(
      heard.actor,
      WorkerBehavior.Self("anna", 1, "one", solver, System.nanoTime()),
      own,
      _ => (),
      _ => ()
    ))
    worker ! WorkerBehavior.Member
    worker ! Message.Welcome(7, question)
    Iterator.continually(heard.next()).collectFirst { case ask: Message.Ask if ask.run == 7 => () }
    for number <- 1L to 2L do
      worker ! Message.Give(7, number, ArraySeq(1))
      assertEquals(
        Iterator.continually(heard.next()).collectFirst { case Message.Failed(7, _, at, why) => (at, why) },
        Some((number, "java.lang.StackOverflowError: too deep"))
      )
    own.shutdownNow(): Unit

  /** A thread that ends without a trace on the console. */
  private def silent(body: Runnable): Thread =
    val made = Thread(body)
    made.setUncaughtExceptionHandler((_, _) => ())
    made

  test("a worker that has computed blocks reports them once every ten beats"):
    val heard  = Heard[ToCoordinator]()
    val solver = new BlockSolverFactory:
      def of(asked: ArraySeq[Byte]) = Right(() => work => work)
    // Its reports queue with its requests: one for each beat.
    val worker = system.spawnAnonymous(WorkerBehavior(
      heard.actor,
      WorkerBehavior.Self("anna", 1, "one", solver, System.nanoTime()),
      pool,
      text => heard.actor ! Message.Unable(7, "anna", text),
      _ => ()
    ))
    worker ! WorkerBehavior.Member
    worker ! Message.Welcome(7, question)
    Iterator.continually(heard.next()).collectFirst { case ask: Message.Ask if ask.run == 7 => () }
    worker ! Message.Give(7, 1, ArraySeq(1))
    Iterator.continually(heard.next()).collectFirst { case done: Message.Done => done }
    for _ <- 1 to 30 do worker ! WorkerBehavior.Beat
    def untilReport() =
      Iterator.continually(heard.next()).take(20).takeWhile(_.isInstanceOf[Message.Ask]).size
    untilReport(): Unit
    assertEquals((untilReport(), untilReport()), (10, 10))

  test("a worker notices the loss of its own coordinator, but ignores the loss of other members"):
    val config = NodeConfig.of(skein.link.Address("127.0.0.1", 0), None).fold(fail(_), identity)
    val node   = ActorSystem("member", config)
    try
      val own   = Cluster(node.toTyped).selfMember
      val other = own.address.copy(port = Some(1))
      for gone <- Seq(UnreachableMember(own), MemberRemoved(own, MemberStatus.Up)) do
        assert(WorkerNode.isLost(own.address, gone), gone)
        assert(!WorkerNode.isLost(other, gone), gone)
      assert(!WorkerNode.isLost(own.address, ReachableMember(own)))
    finally Await.result(node.terminate(), 30.seconds): Unit

  private def newLedger(): Ledger =
    Ledger.open(temporaryFolder().resolve(Ledger.Name), ArraySeq.fill(32)(7)).fold(fail(_), identity)

  test("ended and unreachable members are removed, and all other workers are dismissed when all is done"):
    val ledger      = newLedger()
    val down        = LinkedBlockingQueue[Address]()
    val coordinator =
      system.spawnAnonymous(CoordinatorBehavior(
        Job(7, "one", question),
        ledger,
        _ => (),
        _ => (),
        down.add(_): Unit
      ))
    def worker(name: String, run: Long) =
      val heard = Heard[ToWorker]()
      coordinator ! Message.Ask(name, 1, "one", run, Set.empty, heard.actor)
      heard
    val preparing = worker("anna", 0)
    assertEquals(preparing.next(), Message.Welcome(7, question))
    val working = worker("ben", 7)
    // Even before its first request for a block.
    worker("dora", 0).next(): Unit
    coordinator ! CoordinatorBehavior.Ended("dora")
    assertEquals(down.poll(30, TimeUnit.SECONDS), system.deadLetters.path.address)
    val elsewhere = Address("pekko", "behaviors", "somewhere", 2552)
    coordinator ! CoordinatorBehavior.Unreachable(elsewhere)
    assertEquals(down.poll(30, TimeUnit.SECONDS), elsewhere)
    // A member that has left is not removed again: another may have its address by now.
    coordinator ! CoordinatorBehavior.Removed(elsewhere)
    coordinator ! CoordinatorBehavior.Farewell
    assertEquals(preparing.next(), Message.Goodbye)
    assertEquals(working.next(), Message.Goodbye)
    assertEquals(worker("cleo", 0).next(), Message.Goodbye)
    assert(down.isEmpty, down.toString)
    ledger.close()

  test("a call is answered in the order of its works once all have answers, and equal works are one block"):
    val ledger      = newLedger()
    val latest      = AtomicReference(ClusterProgress())
    val coordinator = system.spawnAnonymous(
      CoordinatorBehavior(Job(7, "one", question), ledger, _ => (), latest.set, _ => ())
    )
    val (a, b)  = (ArraySeq[Byte](1), ArraySeq[Byte](2))
    val promise = Promise[CoordinatorBehavior.Outcome]()
    val news    = LinkedBlockingQueue[ArraySeq[Byte]]()
    coordinator ! CoordinatorBehavior.Compute(Vector(a, b, a), news.add(_): Unit, () => (), promise)
    val worker = Heard[ToWorker]()
    coordinator ! Message.Ask("anna", 2, "one", 7, Set.empty, worker.actor)
    assertEquals(Seq(worker.next(), worker.next()), Seq(Message.Give(7, 1, a), Message.Give(7, 2, b)))
    coordinator ! Message.Done(7, "anna", 2, 5, ArraySeq(20))
    assertEquals(Option(news.poll(30, TimeUnit.SECONDS)), Some(ArraySeq[Byte](20)))
    coordinator ! Message.Done(7, "anna", 2, 5, ArraySeq(30))
    // Its answer shows that the messages before it are done with.
    coordinator ! Message.Ask("ben", 1, "one", 0, Set.empty, worker.actor)
    assertEquals(worker.next(), Message.Welcome(7, question))
    assertEquals((latest.get.done, latest.get.of, promise.isCompleted), (1, 2, false))
    coordinator ! Message.Done(7, "anna", 1, 5, ArraySeq(10))
    val all = Await.result(promise.future, 30.seconds)
    assertEquals(all, Right(Some(Vector(10, 20, 10).map(answer => ArraySeq(answer.toByte)))))
    coordinator ! Message.Ask("ben", 1, "one", 0, Set.empty, worker.actor)
    assertEquals(worker.next(), Message.Welcome(7, question))
    assertEquals((latest.get.done, latest.get.of, latest.get.resumed), (0, 0, 0L))
    ledger.close()

  test("a worker that found nothing to do gets a later block without another request"):
    val ledger      = newLedger()
    val coordinator = system.spawnAnonymous(
      CoordinatorBehavior(Job(7, "one", question), ledger, _ => (), _ => (), _ => ())
    )
    val worker  = Heard[ToWorker]()
    val promise = Promise[CoordinatorBehavior.Outcome]()
    val wanted  = LinkedBlockingQueue[String]()
    coordinator ! Message.Ask("anna", 1, "one", 7, Set.empty, worker.actor)
    coordinator ! CoordinatorBehavior.Compute(
      Vector(ArraySeq[Byte](1)),
      _ => (),
      () => wanted.add("wanted"): Unit,
      promise
    )
    assertEquals(worker.next(), Message.Give(7, 1, ArraySeq[Byte](1)))
    assertEquals(wanted.asScala.toVector, Vector("wanted"))
    ledger.close()

  test("a coordinator does nothing before its first message"):
    assertEquals(ClusterProgress(), ClusterProgress(Coordinator(), done = 0, of = 0, resumed = 0, died = 0))

  for gone <- Seq(
      CoordinatorBehavior.Ended("anna"),
      CoordinatorBehavior.Unreachable(system.deadLetters.path.address),
      CoordinatorBehavior.Removed(system.deadLetters.path.address)
    )
  do
    test(
      s"the receiver of news that a worker joined or is ${gone.getClass.getSimpleName} sees it in the progress"
    ):
      val ledger      = newLedger()
      val latest      = AtomicReference(ClusterProgress())
      val seen        = LinkedBlockingQueue[(WorkerEvent, ClusterProgress)]()
      val coordinator =
        system.spawnAnonymous(CoordinatorBehavior(
          Job(7, "one", question),
          ledger,
          event => seen.add(event -> latest.get): Unit,
          latest.set,
          _ => ()
        ))
      def next() = Option(seen.poll(30, TimeUnit.SECONDS)).getOrElse(fail("nothing was told"))
      coordinator ! Message.Ask("anna", 1, "one", 7, Set.empty, Heard[ToWorker]().actor)
      val (joined, withAnna) = next()
      assertEquals(joined, WorkerEvent.Joined("anna", 1))
      assertEquals(withAnna.coordinator.workers.keySet, Set("anna"))
      coordinator ! gone
      val (lost, without) = next()
      assertEquals(lost, WorkerEvent.Lost("anna", 0))
      assertEquals((without.died, without.coordinator.workers("anna").isHere), (1, false))
      ledger.close()
