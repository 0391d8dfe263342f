package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.units.*
import skein.vtime.VirtualTime

class PaceSuite extends munit.FunSuite:

  /** Times of emission with the elements, which are times of arrival in ms, and the replaced elements. The
    * interval is 100 ms.
    */
  private def paced(arrivalsMs: Long*) =
    var replaced = Vector.empty[Long]
    val run      = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      val clock         = Clock.ofNanos(VirtualTime.clock(system))
      val start         = clock.now()
      Source(arrivalsMs)
        .mapAsync(arrivalsMs.size)(at => after(at.millis)(Future.successful(at)))
        .concat(Source.maybe)
        .via(Pace(Span.ofMillis(100), clock)(replaced :+= _))
        .map(element => (clock.now().since(start).toNanos / 1_000_000, element))
        .takeWithin(1.second)
        .runWith(Sink.seq)
    (run.value, replaced)

  test("two emissions are never closer than the interval, and the newest wins"):
    val (emitted, replaced) = paced(18, 50, 70, 110, 230, 301)
    assertEquals(emitted, Seq(18L -> 18L, 118L -> 110L, 230L -> 230L, 330L -> 301L))
    assertEquals(replaced, Seq(50L, 70L))

  test("a late element delays only itself"):
    val (emitted, _) = paced(0, 190, 300, 400)
    assertEquals(emitted, Seq(0L -> 0L, 190L -> 190L, 300L -> 300L, 400L -> 400L))
