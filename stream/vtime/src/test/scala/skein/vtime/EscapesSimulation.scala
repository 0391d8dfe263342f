package skein.vtime

import com.typesafe.config.ConfigFactory
import org.apache.pekko.Done
import org.apache.pekko.actor.{Actor, ActorRef, ActorSystem, Props}
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Sink, Source, Tcp}
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future, Promise}
import skein.testing.Unhurried

/** Anything that would make virtual time wrong stops the run and names the culprit. */
class EscapesSimulation extends munit.FunSuite, Unhurried:
  private def stopped(limits: RunLimits = RunLimits(), config: String = "")(
      body: ActorSystem => Future[?]
  ): VirtualTimeException =
    intercept[VirtualTimeException]:
      VirtualTime.run(1, limits, ConfigFactory.parseString(config).withFallback(ConfigFactory.load()))(body)

  private def assertCulprit(error: VirtualTimeException)(using munit.Location): Unit =
    assert(
      error.getCause.getStackTrace.exists(_.getClassName.startsWith("skein.vtime.EscapesSimulation")),
      "the cause does not show this suite's code"
    )

  test("a promise completed by another thread is reported as an escape, with that thread's stack"):
    val error = stopped(): system =>
      import system.dispatcher
      val promise = Promise[Int]()
      val other   = Thread(() => completeFromOutside(promise), "outsider")
      val result  = promise.future.map(_ + 1)
      other.start()
      other.join()
      result
    error.problem match
      case Problem.ForeignThread("outsider", _) =>
      case other                                => fail(s"another problem: $other")
    assert(error.getCause.getStackTrace.exists(_.getMethodName == "completeFromOutside"))

  private def completeFromOutside(promise: Promise[Int]): Unit =
    try promise.success(1): Unit
    catch case _: VirtualTimeException => ()

  test("a message sent by another thread is an escape, even where its exception is swallowed"):
    val error = stopped(): system =>
      val actor = system.actorOf(Props(Silent()))
      val other = Thread(() => sendFromOutside(actor), "outsider")
      other.start()
      other.join()
      Promise[Done]().future
    assert(clue(error.problem).isInstanceOf[Problem.ForeignThread])

  private def sendFromOutside(actor: ActorRef): Unit =
    try actor ! "hello"
    catch case _: VirtualTimeException => ()

  test("Await on the loop is an escape"):
    val error = stopped(): system =>
      import system.dispatcher
      Future.unit.map(_ => Await.result(Promise[Int]().future, 1.second)).recover(_ => 0)
    assert(clue(error.problem).isInstanceOf[Problem.Blocked])
    assertCulprit(error)

  test("the global execution context on the loop is an escape"):
    val error = stopped()(_ => Future(1)(using ExecutionContext.global))
    assert(clue(error.problem).isInstanceOf[Problem.LeftTheLoop])
    assertCulprit(error)

  test("a context made from an executor is an escape"):
    val pool  = java.util.concurrent.Executors.newSingleThreadExecutor()
    val error = stopped(): _ =>
      Future(1)(using ExecutionContext.fromExecutor(pool))
    pool.shutdown()
    assert(clue(error.problem).isInstanceOf[Problem.LeftTheLoop])

  test("a pinned dispatcher is refused by name"):
    val error =
      stopped(config = "own { type = PinnedDispatcher, executor = thread-pool-executor }"): system =>
        system.actorOf(Props(Silent()).withDispatcher("own")): Unit
        Promise[Done]().future
    assertEquals(error.problem, Problem.NeedsThreads("own"))

  test("a user's own dispatcher with a thread pool runs on the loop"):
    val config = ConfigFactory.parseString("own { type = Dispatcher, executor = thread-pool-executor }")
    val ran    = VirtualTime.run(1, config = config.withFallback(ConfigFactory.load())): system =>
      Future(Thread.currentThread)(using system.dispatchers.lookup("own"))
    assertEquals(ran.value, Thread.currentThread)

  test("TCP is refused"):
    val error = stopped(): system =>
      given ActorSystem = system
      Source.empty.via(Tcp(system).outgoingConnection("127.0.0.1", 1)).runWith(Sink.ignore)
    assertEquals(error.problem, Problem.Sockets)

  test("two actors that talk for ever at one instant are a livelock, whose report names them"):
    val error = stopped(RunLimits(tasksPerInstant = 10_000)): system =>
      val echo = system.actorOf(Props(Echo()), "echo")
      system.actorOf(Props(Echo()), "reply").tell("ball", echo)
      after(1.second)(Future.successful(Done))(using system)
    error.problem match
      case Problem.Livelock(at, _, running) =>
        assertEquals(at, 0.seconds)
        assert(clue(running).exists((name, _) => name.contains("/user/echo")))
      case other => fail(s"another problem: $other")

  test("a stream that never ends at one instant is a livelock after seconds of processor time, not minutes"):
    val threads = java.lang.management.ManagementFactory.getThreadMXBean
    val before  = threads.getCurrentThreadCpuTime
    val error   = stopped(): system =>
      given ActorSystem = system
      Source.repeat(1).runWith(Sink.ignore)
    val taken = (threads.getCurrentThreadCpuTime - before).nanos
    error.problem match
      case Problem.Livelock(at, _, running) =>
        assertEquals(at, 0.seconds)
        assert(clue(running).exists((name, _) => name.contains("StreamSupervisor")))
      case other => fail(s"another problem: $other")
    assert(clue(taken) < 10.seconds)

  test("a stream of many elements at one instant is not a livelock"):
    val run = VirtualTime.run(1): system =>
      given ActorSystem = system
      Source(1 to 3_000_000).runWith(Sink.fold(0L)(_ + _))
    assertEquals(run.value, 4_500_001_500_000L)

  test(
    "a future that nothing can complete is a deadlock; the report states the last event and the live actors"
  ):
    val error = stopped(): system =>
      system.actorOf(Props(Silent()), "silent"): Unit
      after(3.seconds)(Future.successful(Done))(using system).flatMap(_ => Promise[Done]().future)(using
        system.dispatcher
      )
    error.problem match
      case Problem.Deadlock(at, actors) =>
        assertEquals(at, 3.seconds)
        assert(clue(actors).contains("silent"))
      case other => fail(s"another problem: $other")

  test("a run ends at its limit of virtual time"):
    val error = stopped(RunLimits(duration = 10.seconds)): system =>
      given ActorSystem = system
      Source.tick(0.seconds, 1.second, ()).runWith(Sink.ignore)
    assert(clue(error.problem).isInstanceOf[Problem.Overrun])

  test("a run inside of a run is refused"):
    intercept[IllegalStateException]:
      VirtualTime.run(1)(_ => Future.successful(VirtualTime.run(2)(_ => Future.successful(1))))

  test("the failure of the future is thrown unchanged"):
    val error = intercept[ArithmeticException]:
      VirtualTime.run(1)(_ => Future.failed(ArithmeticException("division")))
    assertEquals(error.getMessage, "division")

  test("a system of real time has no virtual clock, and real clocks beside a loop stay real"):
    val before = System.nanoTime()
    VirtualTime.run(1)(system => after(1.hour)(Future.unit)(using system)): Unit
    val outside = Deadline.now.time.toNanos
    assert(
      outside - before < 60_000_000_000L && outside >= before,
      "Deadline.now outside of the loop is not real time"
    )

private final class Echo extends Actor:
  def receive: Receive = message => sender() ! message
