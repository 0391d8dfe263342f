package skein.link

import java.nio.file.Path
import skein.testing.{Lengthy, Optimised}

/** Reads the thread's policy from the system. */
class BackgroundThreadLiveSuite extends munit.FunSuite, Lengthy, Optimised:

  private def onLinux(name: String)(body: => Unit): Unit =
    test(name):
      assume(System.getProperty("os.name") == "Linux", "other systems know no such threads")
      body

  onLinux("a background thread has Linux's idle policy"):
    var policy = -1
    val thread =
      BackgroundThread.factory("background").newThread(() =>
        policy = ThreadPolicy.of(Path.of("/proc/thread-self"))
      )
    assert(thread.isDaemon, "no program waits for its end")
    thread.start()
    thread.join()
    assertEquals(policy, 5)

  onLinux("other threads keep their policy"):
    assertEquals(ThreadPolicy.of(Path.of("/proc/thread-self")), 0)

  onLinux("the compilers' threads get the idle policy, and no others"):
    assert(BackgroundThread.compilersGiveWay() >= 1)
    assertEquals(ThreadPolicy.of(Path.of("/proc/thread-self")), 0)
