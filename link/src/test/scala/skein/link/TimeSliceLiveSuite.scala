package skein.link

import java.util.concurrent.atomic.AtomicReference
import skein.units.*

/** Asks the system itself. */
final class TimeSliceLiveSuite extends munit.FunSuite:

  test("a thread has the shortest slices from then on, and so have those that it starts; others keep theirs"):
    val before = TimeSlice.current
    assume(before.isDefined, "this system tells of no slices: Linux does since 6.12")
    val own, started             = AtomicReference(Option.empty[Span])
    def run(body: => Unit): Unit =
      val thread = Thread(() => body)
      thread.start()
      thread.join()
    run:
      own.set(TimeSlice.shorten())
      run(started.set(TimeSlice.current))
    assertEquals(own.get, Some(TimeSlice.shortest))
    assertEquals(started.get, Some(TimeSlice.shortest))
    assertEquals(TimeSlice.current, before)
