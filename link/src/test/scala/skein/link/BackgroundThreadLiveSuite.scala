package skein.link

import java.nio.file.{Files, Path}
import skein.testing.{Alone, Optimised}

/** Asks the system itself. */
class BackgroundThreadLiveSuite extends munit.FunSuite, Alone, Optimised:

  private def onLinux(name: String)(body: => Unit): Unit =
    test(name):
      assume(System.getProperty("os.name") == "Linux", "other systems know no such threads")
      body

  onLinux("a background thread is scheduled when nobody else wants the processor"):
    var policy = -1
    val thread =
      BackgroundThread.factory("background").newThread(() => policy = policyOf(Path.of("/proc/thread-self")))
    assert(thread.isDaemon, "no program waits for its end")
    thread.start()
    thread.join()
    assertEquals(policy, 5)

  onLinux("other threads are left alone"):
    assertEquals(policyOf(Path.of("/proc/thread-self")), 0)

  onLinux("compilers are made to give way, and nobody else is"):
    assert(BackgroundThread.compilersGiveWay() >= 1)
    assertEquals(policyOf(Path.of("/proc/thread-self")), 0)

  /** The 41st field of proc_pid_stat(5); the second may hold spaces, but ends with the last parenthesis. */
  private def policyOf(thread: Path): Int =
    val stat = Files.readString(thread.resolve("stat"))
    stat.substring(stat.lastIndexOf(')') + 2).split(' ')(41 - 3).toInt
