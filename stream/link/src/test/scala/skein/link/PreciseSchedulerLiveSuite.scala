package skein.link

import java.util.concurrent.atomic.AtomicInteger
import java.util.concurrent.{CountDownLatch, TimeUnit}
import org.apache.pekko.actor.{ActorSystem, Scheduler, SchedulerTask}
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future, Promise}
import skein.signal.SplitMix64
import skein.testing.Timing

/** Uses the real clock. */
class PreciseSchedulerLiveSuite extends munit.FunSuite, Timing:
  private val system             = ActorSystem("precise-scheduler", PreciseScheduler.config)
  private given ExecutionContext = system.dispatcher
  private val scheduler          = system.scheduler

  override def afterAll(): Unit = system.terminate(): Unit

  private def after[A](delay: FiniteDuration)(result: => A): Future[A] =
    val promise = Promise[A]()
    scheduler.scheduleOnce(delay)(promise.success(result): Unit): Unit
    promise.future

  test("an actor system loads the scheduler from its configuration"):
    assertEquals(scheduler.getClass, classOf[PreciseScheduler])

  /** The first measurement that passes, or the fifth: the scheduler's part is equal each time, a busy
    * machine's is not.
    */
  private def untilItHolds[A](measure: => Future[A], tries: Int = 5)(holds: A => Boolean): Future[A] =
    measure.flatMap: result =>
      if holds(result) || tries == 1 then Future.successful(result)
      else untilItHolds(measure, tries - 1)(holds)

  test("tasks start when they are due: never before, and half of them within 1 ms"):
    val random                          = SplitMix64(1)
    def latesUs(): Future[Vector[Long]] =
      Future
        .traverse(Vector.fill(500)(1.millisecond * (1 + random.nextInt(1000)))): delay =>
          val due = System.nanoTime() + delay.toNanos
          after(delay)((System.nanoTime() - due) / 1000)
        .map(_.sorted)
    untilItHolds(latesUs())(late => late.head < 0 || late(250) < 1000).map: late =>
      println(s"late by (us): p50 ${late(250)}, p90 ${late(450)}, p99 ${late(495)}, max ${late.last}")
      assert(late.head >= 0, late.head)
      assert(late(250) < 1000, late(250))

  test("a fixed rate does not drift, a fixed delay waits after each run"):
    def spanOf(start: Runnable => org.apache.pekko.actor.Cancellable): Future[Long] =
      val began = System.nanoTime()
      val runs  = AtomicInteger()
      val done  = Promise[Long]()
      val task  = start: () =>
        val until = System.nanoTime() + 2_000_000
        while System.nanoTime() < until do Thread.onSpinWait()
        if runs.incrementAndGet() == 20 then done.trySuccess((System.nanoTime() - began) / 1_000_000): Unit
      done.future.andThen(_ => task.cancel())
    for
      atRate    <- untilItHolds(spanOf(scheduler.scheduleAtFixedRate(5.millis, 5.millis)(_)))(_ < 138)
      withDelay <- spanOf(scheduler.scheduleWithFixedDelay(5.millis, 5.millis)(_))
    yield
      assert(atRate >= 100 && atRate < 138, s"20 runs of 2 ms every 5 ms took $atRate ms")
      assert(withDelay >= 138, s"20 runs of 2 ms, 5 ms apart, took $withDelay ms")

  test("a cancelled task never runs, its cancellation is reported, and a second cancellation is refused"):
    final class Task extends SchedulerTask:
      @volatile var (ran, told)      = (false, false)
      def run(): Unit                = ran = true
      override def cancelled(): Unit = told = true
    // A busy machine may run the first ones before they can be cancelled.
    val (task, handle) = Iterator
      .continually:
        val task = Task()
        (task, scheduler.scheduleOnce(20.millis, task))
      .find(_._2.cancel())
      .get
    assert(task.told)
    assert(!handle.cancel())
    assert(handle.isCancelled)
    after(40.millis)(assert(!task.ran))

  test("a task that has run can no longer be cancelled"):
    val done = Promise[Unit]()
    val task = scheduler.scheduleOnce(1.milli)(done.success(()): Unit)
    for _ <- done.future yield
      assert(!task.cancel())
      assert(!task.isCancelled)

  test("a repeated task stops when cancelled, even by itself"):
    val runs = AtomicInteger()
    val self = Promise[org.apache.pekko.actor.Cancellable]()
    self.success(
      scheduler.scheduleWithFixedDelay(1.milli, 1.milli): () =>
        if runs.incrementAndGet() == 3 then self.future.foreach(_.cancel())(using ExecutionContext.parasitic)
    )
    after(50.millis)(assertEquals(runs.get, 3))

  test("a repeated task that throws is not run again"):
    val runs  = AtomicInteger()
    val quiet = new ExecutionContext:
      def execute(runnable: Runnable): Unit =
        summon[ExecutionContext].execute(() =>
          try runnable.run()
          catch case _: ArithmeticException => ()
        )
      def reportFailure(cause: Throwable): Unit = ()
    scheduler
      .scheduleAtFixedRate(1.milli, 1.milli)(() =>
        throw ArithmeticException(s"run ${runs.incrementAndGet()}")
      )(using quiet): Unit
    after(30.millis)(assertEquals(runs.get, 1))

  test("a period of zero is refused"):
    intercept[IllegalArgumentException](scheduler.scheduleAtFixedRate(1.milli, Duration.Zero)(() => ())): Unit

  test("a closing scheduler runs only tasks marked for it, and refuses new ones"):
    val closing = ActorSystem("closing", PreciseScheduler.config)
    val ran     = CountDownLatch(1)
    val other   = AtomicInteger()
    closing.scheduler.scheduleOnce(1.hour, (() => ran.countDown()): Scheduler.TaskRunOnClose): Unit
    closing.scheduler.scheduleOnce(1.hour)(other.incrementAndGet(): Unit): Unit
    Await.result(closing.terminate(), 10.seconds): Unit
    assert(ran.await(5, TimeUnit.SECONDS))
    assertEquals(other.get, 0)
    intercept[IllegalStateException](closing.scheduler.scheduleOnce(1.milli)(())): Unit
    intercept[IllegalStateException](closing.scheduler.scheduleOnce(Duration.Zero)(())): Unit
