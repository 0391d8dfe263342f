package skein.link

import java.util.concurrent.{ConcurrentLinkedQueue, CountDownLatch, ThreadFactory, TimeUnit}
import scala.jdk.CollectionConverters.*
import skein.testing.Unhurried
import skein.units.Span

/** Runs tasks on real threads. */
class BackgroundExecutorLiveSuite extends munit.FunSuite, Unhurried:

  private def made(threads: ConcurrentLinkedQueue[Thread]): ThreadFactory = work =>
    val thread = Thread(work)
    thread.setDaemon(true)
    threads.add(thread)
    thread

  private val (background, usual) = (ConcurrentLinkedQueue[Thread](), ConcurrentLinkedQueue[Thread]())

  override def beforeEach(context: BeforeEach): Unit =
    background.clear()
    usual.clear()

  /** The threads on which 100 tasks ran, in order. */
  private def ran(patience: Span): Vector[Thread] =
    val on       = ConcurrentLinkedQueue[(Int, Thread)]()
    val all      = CountDownLatch(100)
    val executor = new BackgroundExecutor(made(background), made(usual), patience)
    try
      for number <- 1 to 100 do
        executor.execute: () =>
          on.add((number, Thread.currentThread))
          all.countDown()
      assert(all.await(60, TimeUnit.SECONDS))
      assertEquals(on.asScala.map(_._1).toVector, (1 to 100).toVector)
      on.asScala.map(_._2).toVector
    finally executor.close()

  test("a thread that did not get the processor in a slice is replaced by an ordinary one"):
    val on = ran(Span.ofSeconds(-1))
    background.forEach(_.join(60_000))
    assert(!background.asScala.exists(_.isAlive))
    assertEquals((background.size, usual.size), (1, 1))
    assertEquals(on, background.peek +: Vector.fill(99)(usual.peek))

  test("a thread that got the processor is kept"):
    assertEquals(ran(Span.ofSeconds(3600)), Vector.fill(100)(background.peek))
    assertEquals((background.size, usual.size), (1, 0))

  test("a task that waits for ever is interrupted on close"):
    val executor = new BackgroundExecutor(made(background), made(usual))
    val began    = CountDownLatch(1)
    executor.execute: () =>
      began.countDown()
      try CountDownLatch(1).await()
      catch case _: InterruptedException => ()
    assert(began.await(60, TimeUnit.SECONDS))
    executor.close()
    background.peek.join(60_000)
    assert(!background.peek.isAlive)
