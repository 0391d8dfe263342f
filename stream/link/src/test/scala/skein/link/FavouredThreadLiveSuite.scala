package skein.link

import java.nio.file.{Files, Path}
import java.util.concurrent.{LinkedBlockingQueue, ThreadFactory}
import skein.testing.Unhurried

/** Reads from Linux how it schedules threads. */
class FavouredThreadLiveSuite extends munit.FunSuite, Unhurried:
  override def munitIgnore: Boolean = System.getProperty("os.name") != "Linux"

  private val roundRobin = 2

  /** Policy and real-time priority of the calling thread: fields 41 and 40 of proc_pid_stat(5). */
  private def scheduled: (policy: Int, priority: Int) =
    val stat   = Files.readString(Path.of("/proc/thread-self/stat"))
    val fields = stat.drop(stat.lastIndexOf(')') + 2).split(' ')
    (fields(38).toInt, fields(37).toInt)

  private def on(threads: ThreadFactory)(first: => Unit = ()): (policy: Int, priority: Int) =
    val found = LinkedBlockingQueue[(policy: Int, priority: Int)]()
    threads.newThread { () =>
      first; found.add(scheduled): Unit
    }.start()
    found.take()

  test("a favoured thread precedes all others except control threads, where the system allows it"):
    val favoured = on(FavouredThread.factory("favoured"))()
    assume(favoured.policy == roundRobin, "this user may not take real-time priority")
    val control = on(Thread.ofPlatform().daemon().factory()):
      SchedulingPolicy.thisThread.foreach(SchedulingPolicy.RealTime.schedule)
    assertEquals(control.policy, roundRobin)
    assert(favoured.priority < control.priority, (favoured, control))
