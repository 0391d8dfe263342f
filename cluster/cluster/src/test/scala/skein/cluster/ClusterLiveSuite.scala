package skein.cluster

import java.net.{InetAddress, ServerSocket}
import java.nio.file.{Files, Path}
import java.util.concurrent.atomic.AtomicInteger
import java.util.concurrent.{ConcurrentLinkedQueue, CountDownLatch, Semaphore, TimeUnit}
import scala.collection.immutable.ArraySeq
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future, blocking}
import scala.jdk.CollectionConverters.*
import scala.util.{Try, Using}
import skein.blocks.Ledger
import skein.link.Address
import skein.testing.{TemporaryFolders, Unhurried}

/** Coordinator and workers as nodes of their own in one JVM, over loopback. */
class ClusterLiveSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  import scala.concurrent.ExecutionContext.Implicits.global

  private val loopback = Address("127.0.0.1", 0)
  private val question = bytes("reverse")
  private val works    = Vector.tabulate(120)(number => bytes(s"block $number"))
  private val answers  = works.map(_.reverse)

  private def bytes(text: String): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(text.getBytes("UTF-8"))

  /** A solver that reverses bytes, and counts its calls.
    *
    * @param before called before each block
    */
  private final class Reversing(before: () => Unit = () => ()) extends BlockSolverFactory:
    val solved                    = AtomicInteger()
    def of(asked: ArraySeq[Byte]) =
      Either.cond(
        asked == question,
        () =>
          work =>
            before()
            solved.incrementAndGet(): Unit
            work.reverse
        ,
        "no such question"
      )

  private final class Coordinating(
      val folder: Path,
      port: Int = 0,
      host: String = loopback.host,
      tls: Option[Tls] = None
  ) extends AutoCloseable:
    val news   = ConcurrentLinkedQueue[WorkerEvent]()
    val joined = Semaphore(0)
    val ledger = Ledger.open(folder.resolve(Ledger.Name), ArraySeq.fill(32)(7)).fold(fail(_), identity)
    val node   = CoordinatorNode
      .start(Address(host, port), tls, question, ledger, "one")(heard)
      .fold(fail(_), identity)

    private def heard(one: WorkerEvent): Unit =
      if one.isInstanceOf[WorkerEvent.Joined] then joined.release()
      news.add(one): Unit

    def close(): Unit =
      Await.result(node.close(), 30.seconds)
      ledger.close()

  /** Runs the body with a coordinator; the body's failure is reported even if closing fails, too. */
  private def coordinating(tls: Option[Tls])(body: Coordinating => Unit): Unit =
    Using.resource(Coordinating(temporaryFolder(), tls = tls))(body)

  private def coordinating(body: Coordinating => Unit): Unit = coordinating(None)(body)

  private def worker(
      to: Address,
      name: String,
      solvers: BlockSolverFactory,
      build: String = "one",
      cores: Int = 1,
      tls: Option[Tls] = None,
      patience: FiniteDuration = 60.seconds
  ) =
    val told = ConcurrentLinkedQueue[String]()
    val node =
      WorkerNode(to, loopback, tls, cores, solvers, patience, name, build)(told.add(_): Unit)
    (node, Future(blocking(node.run())), told)

  /** Certificate folders of a lab, one for each host. Made by other processes, since waiting for them is most
    * of the work.
    */
  private def certificates(hosts: String*): Future[Vector[Path]] = Future(blocking(
    Certificates.make(temporaryFolder(), hosts).fold(fail(_), identity)
  ))
  private val makingLab    = certificates("127.0.0.1", "*.workers.lab", "::1")
  private val makingOthers = certificates("127.0.0.1")
  private lazy val lab     = Await.result(makingLab, 60.seconds)

  private def tls(folder: Path): Tls = Tls.of(folder).fold(fail(_), identity)

  private def computed(node: CoordinatorNode) =
    Await.result(node.compute(works), 60.seconds).fold(fail(_), _.get)

  test("workers join, every block counts once, and a second call finds its answers in the ledger"):
    coordinating: coordinator =>
      val solvers = Reversing()
      val ended   = Vector("anna", "ben", "cleo").map(name =>
        worker(coordinator.node.address, name, solvers, cores = 2)._2
      )
      assert(coordinator.joined.tryAcquire(3, 60, TimeUnit.SECONDS), "not all have joined")
      assertEquals(computed(coordinator.node), answers)
      val solved = solvers.solved.get
      assertEquals(coordinator.node.progress.coordinator.counts.accepted, works.size.toLong)
      assertEquals(computed(coordinator.node), answers)
      assertEquals(solvers.solved.get, solved, "nothing is computed twice")
      assertEquals(coordinator.ledger.size, works.size)
      coordinator.node.close(): Unit
      for end <- ended do assertEquals(Await.result(end, 30.seconds), Right(()))

  test("workers join a coordinator that listens at an IPv6 address"):
    val address = Try(ServerSocket(0, 1, InetAddress.ofLiteral("::1"))).map(_.close())
    assume(address.isSuccess, "this machine has no IPv6")
    Using.resource(Coordinating(temporaryFolder(), host = "::1")): coordinator =>
      val (anna, _, _) = worker(coordinator.node.address, "anna", Reversing())
      assertEquals(computed(coordinator.node), answers)
      assert(coordinator.node.address.toString.startsWith("[::1]:"))
      anna.stop()

  test("a worker that is still preparing when all is done is dismissed, and ends immediately"):
    val asked = CountDownLatch(1)
    val never = CountDownLatch(1)
    var ended = Option.empty[(Future[Either[String, Unit]], ConcurrentLinkedQueue[String])]
    coordinating: coordinator =>
      val (_, end, told) = worker(
        coordinator.node.address,
        "anna",
        _ =>
          asked.countDown()
          never.await()
          Left("was interrupted")
      )
      ended = Some((end, told))
      asked.await()
    for (end, told) <- ended do
      assertEquals(Await.result(end, 15.seconds), Right(()))
      assert(clue(told.asScala.last).contains("the work is done"))

  test("a worker of another build is refused with both builds named, and so is one that cannot answer"):
    coordinating: coordinator =>
      val (_, other, _) = worker(coordinator.node.address, "anna", Reversing(), build = "two")
      val refusal       = Await.result(other, 30.seconds).swap.getOrElse(fail("was taken"))
      assert(clue(refusal).contains("its build is two, expected the coordinator's, one"))
      val (_, without, _) = worker(coordinator.node.address, "ben", _ => Left("no scenario 'ridge'"))
      val unable          = Await.result(without, 30.seconds).swap.getOrElse(fail("was taken"))
      assert(clue(unable).contains("no scenario 'ridge'"))
      val told = coordinator.news.asScala.map(_.text).toVector
      assert(clue(told).exists(_.contains("refused anna: its build is two")))

  private def garbage(port: Int): Unit =
    Garbage.send(port, 0 until 330)(Garbage.of)
    Garbage.send(port, 0 until 40)(Garbage.endless)

  /** Checks workers before, during and after an attack with garbage. */
  private def assertUnharmed(coordinator: Coordinating, tls: Option[Tls])(send: Int => Unit): Unit =
    val to           = coordinator.node.address
    val sent         = CountDownLatch(1)
    val (anna, _, _) = worker(to, "anna", Reversing(() => sent.await()), tls = tls)
    assert(coordinator.joined.tryAcquire(60, TimeUnit.SECONDS), "anna has not joined")
    val answered = coordinator.node.compute(works)
    send(to.port)
    sent.countDown()
    val (ben, _, _) = worker(to, "ben", Reversing(), tls = tls)
    assert(coordinator.joined.tryAcquire(60, TimeUnit.SECONDS), "ben has not joined")
    assertEquals(Await.result(answered, 60.seconds).fold(fail(_), _.get), answers)
    val now = coordinator.node.progress
    assertEquals(now.coordinator.workers.keySet, Set("anna", "ben"))
    assertEquals((now.died, now.coordinator.counts.lost), (0, 0L))
    anna.stop()
    ben.stop()

  test("garbage sent to the port by an outsider does no harm: members continue, and others can join"):
    coordinating(assertUnharmed(_, None)(garbage))

  test("garbage from a stranger does no harm where certificates are required, either"):
    val own = Some(tls(lab.head))
    coordinating(own)(assertUnharmed(_, own)(garbage))

  test("blocks of a worker that leaves are computed by another"):
    coordinating: coordinator =>
      val taken        = CountDownLatch(1)
      val never        = CountDownLatch(1)
      val (node, _, _) = worker(
        coordinator.node.address,
        "anna",
        Reversing(() =>
          taken.countDown()
          never.await()
        )
      )
      val answered = coordinator.node.compute(works)
      taken.await()
      node.stop()
      val (ben, _, _) = worker(coordinator.node.address, "ben", Reversing())
      assertEquals(Await.result(answered, 60.seconds).fold(fail(_), _.get), answers)
      assertEquals(coordinator.node.progress.coordinator.workers("ben").accepted, works.size.toLong)
      ben.stop()

  test("a coordinator restarted at its address finds its workers and its answers"):
    val folder  = temporaryFolder()
    val first   = Coordinating(folder)
    val port    = first.node.address.port
    val reached = CountDownLatch(30)
    val dead    = CountDownLatch(1)
    val solvers = Reversing: () =>
      if reached.getCount == 0 then dead.await()
      reached.countDown()
    // Its end is not announced, as if it was killed.
    val (node, _, told) = worker(first.node.address, "anna", solvers)
    first.node.compute(works): Unit
    reached.await()
    first.node.kill()
    dead.countDown()
    first.ledger.close()
    val had    = Ledger.audit(folder.resolve(Ledger.Name))
    val second = Coordinating(folder, port)
    try
      assertEquals(computed(second.node), answers)
      assertEquals(second.node.progress.resumed, had.blocks.toLong)
      assertEquals((had.repeats, had.broken), (0, 0L))
      assertEquals(Ledger.audit(folder.resolve(Ledger.Name)), Ledger.Audit(works.size, 0, 0))
      assert(had.blocks >= 29 && had.blocks < works.size, had.toString)
    finally
      node.stop()
      second.close()
    assert(clue(told.asScala.toVector).exists(_.contains("joined")))
    // Some of its minute is over when it has lost the first one.
    val left = told.asScala.toVector.collect { case s"$_; joining again, for $left s at most" => left.toInt }
    assert(clue(left).nonEmpty && left.forall(_ < 60))

  test("beyond loopback no node listens or connects without certificates"):
    val folder  = temporaryFolder()
    val ledger  = Ledger.open(folder.resolve(Ledger.Name), ArraySeq.fill(32)(7)).fold(fail(_), identity)
    val refused = CoordinatorNode.start(Address("0.0.0.0", 0), None, question, ledger, "one")(_ => ())
    assert(clue(refused.swap.getOrElse("started")).contains("certificates"))
    ledger.close()
    val joined = WorkerNode(Address("192.0.2.1", 1), loopback, None, 1, Reversing(), 1.second)(_ => ()).run()
    assert(clue(joined.swap.getOrElse("joined")).contains("certificates"))

  test(
    "nodes join with certificates of one set, but not without any, or with those of another set or host"
  ):
    val Vector(own, elsewhere, _) = lab.map(tls): @unchecked
    val strangers                 = tls(Await.result(makingOthers, 60.seconds).head)
    coordinating(Some(own)): coordinator =>
      val to      = coordinator.node.address
      val solvers = Reversing()
      val refused =
        Vector("plain" -> None, "stranger" -> Some(strangers), "elsewhere" -> Some(elsewhere)).map:
          (name, tls) => worker(to, name, solvers, tls = tls, patience = 3.seconds)._2
      val (anna, _, _) = worker(to, "anna", solvers, tls = Some(own))
      assertEquals(computed(coordinator.node), answers)
      val whys = Vector(
        Vector(s"no coordinator at $to", "asks for certificates: expected --tls FOLDER"),
        Vector(s"no coordinator at $to", s"no trusted connection to $to, "),
        Vector("expected a certificate that shows 127.0.0.1", "shows *.workers.lab")
      )
      for (outcome, why) <- refused.zip(whys) do
        val told = Await.result(outcome, 90.seconds)
        assert(clue(told).left.exists(reason => why.forall(reason.contains)))
      assertEquals(coordinator.node.progress.coordinator.workers.keySet, Set("anna"))
      // It learns of failed attempts: from an alert, or when a peer does not speak TLS.
      val told = coordinator.news.asScala.collect { case WorkerEvent.NotTrusted(reason) => reason }.toSet
      assert(clue(told).exists(_.contains("Received fatal alert")))
      assert(told.exists(_.contains("SSL message")))
      anna.stop()
    coordinating: coordinator =>
      val to              = coordinator.node.address
      val (_, outcome, _) = worker(to, "secured", Reversing(), tls = Some(own), patience = 3.seconds)
      val told            = Await.result(outcome, 90.seconds)
      assert(clue(told).left.exists(_.contains(s"to $to, which does not answer as TLS does")))

  test("a node listens only at a host that its certificate names"):
    val Vector(own, elsewhere, sixth) = lab.map(tls): @unchecked
    assertEquals(own.shows("127.0.0.1"), Right(()))
    for host <- Seq("::1", "0:0:0:0:0:0:0:1") do assertEquals(sixth.shows(host), Right(()))
    assert(sixth.shows("::2").isLeft)
    assertEquals(elsewhere.shows("a.workers.lab"), Right(()))
    assertEquals(elsewhere.shows("A.Workers.Lab"), Right(()))
    for host <- Seq("localhost", "127.0.0.2", "1.127.0.0.1") do
      assert(clue(own.shows(host)).left.exists(_.contains("shows 127.0.0.1")))
    for host <- Seq("workers.lab", "a.b.workers.lab", "workers.lab.org", "127.0.0.1") do
      assert(clue(elsewhere.shows(host)).left.exists(_.contains("shows *.workers.lab")))

  test("a set's folders are readable only by their owner, and a certificate is not made twice"):
    val folder = lab.head.getParent
    assertEquals(lab.map(_.getFileName.toString), Vector("127.0.0.1", "_.workers.lab", "::1"))
    for key <-
        Seq(folder.resolve("signer.p12"), lab.head.resolve(Tls.KeyStore), lab.head.resolve(Tls.Password))
    do
      assertEquals(Files.getPosixFilePermissions(key).size, 2, key.toString)
    assert(clue(Certificates.make(folder, Seq("127.0.0.1")).swap.getOrElse("made")).contains("already"))
    assert(clue(Certificates.make(folder, Seq("new.lab", "127.0.0.1"))).isLeft)
    assert(!Files.exists(folder.resolve("new.lab")), "nothing is made where something is refused")
    val none = folder.resolve("none")
    for host <- Seq("no host", "", ":", "1.2.3.4.5", "fe80::1%lo", "1:2", "::1,dns:else") do
      assert(clue(Certificates.make(none, Seq(host)).swap.getOrElse("made")).contains(s"'$host'"))
    assert(!Files.exists(none))
