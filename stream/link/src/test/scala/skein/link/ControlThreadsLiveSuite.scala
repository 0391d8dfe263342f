package skein.link

import java.nio.file.Path
import java.util.concurrent.ConcurrentHashMap
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source, Tcp}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.jdk.CollectionConverters.*
import skein.testing.Unhurried

/** Reads from Linux how it schedules the threads of this JVM, which keep their policy for good. */
class ControlThreadsLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("control-threads", PreciseScheduler.config)
  private given ExecutionContext    = ExecutionContext.parasitic

  override def afterAll(): Unit = system.terminate(): Unit

  override def munitIgnore: Boolean = System.getProperty("os.name") != "Linux"

  private val (usual, roundRobin) = (0, 2)

  test(
    "control threads, also later ones, get the real-time policy, and blocking threads and their children " +
      "do not"
  ):
    val before  = policyOnControl(using system.dispatcher)
    val mayLead =
      before.flatMap: policy =>
        assertEquals(policy, usual)
        ControlThreads.lead()
        policyOnControl(using system.dispatcher)
    for
      control <- mayLead
      _ = assume(control == roundRobin, "this user may not take real-time priority")
      timed    <- onTimer()
      blocking <- policyOnControl(using system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId))
      child    <- Future(childsPolicy())(using system.dispatcher)
      _        <- echoed()
    yield
      assertEquals(timed, roundRobin)
      assertEquals(blocking, usual)
      assertEquals(child, usual)
      assert(policiesOf("control-threads").contains(roundRobin))

  private def policyOnControl(using ExecutionContext): Future[Int] =
    Future(ThreadPolicy.of(Path.of("/proc/thread-self")))

  /** The policy of the thread that runs timers. */
  private def onTimer(): Future[Int] =
    val found = Promise[Int]()
    system.scheduler.scheduleOnce(1.milli)(
      found.success(ThreadPolicy.of(Path.of("/proc/thread-self"))): Unit
    )(using
      ExecutionContext.parasitic
    )
    found.future

  private def childsPolicy(): Int =
    val found  = ConcurrentHashMap.newKeySet[Int]()
    val thread = Thread(() => found.add(ThreadPolicy.of(Path.of("/proc/thread-self"))): Unit)
    thread.start()
    thread.join()
    found.asScala.head

  /** Sends bytes to a socket and back, so that its threads have run. */
  private def echoed(): Future[ByteString] =
    for
      bound <- Tcp().bind("127.0.0.1", 0).to(Sink.foreach(_.handleWith(Flow[ByteString]): Unit)).run()
      back  <- Source
        .single(ByteString("there and back"))
        .via(Tcp().outgoingConnection(bound.localAddress))
        .runFold(ByteString.empty)(_ ++ _)
      _ <- bound.unbind()
    yield
      assertEquals(back.utf8String, "there and back")
      back

  private def policiesOf(beginning: String): Vector[Int] =
    SchedulingPolicy.threadsNamed(beginning).map(thread =>
      ThreadPolicy.of(Path.of(s"/proc/self/task/$thread"))
    )
