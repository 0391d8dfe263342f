package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.{Future, Promise}
import scala.concurrent.duration.*
import skein.vtime.VirtualTime

class LearnSuite extends munit.FunSuite:

  test(
    "a lesson has the elements received during the last one, and the oldest beyond the bound are reported"
  ):
    var dropped = Vector.empty[Int]
    val lessons = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      Source(1 to 12)
        .throttle(1, 100.millis)
        .via(Learn[Int, Vector[Int]](3, element => dropped :+= element): lesson =>
          after(450.millis)(Future.successful(Option.when(!lesson.contains(1))(lesson))))
        .runWith(Sink.seq)
    // The first lesson lasts from 0 to 450 ms: 2 to 5 arrive meanwhile.
    assertEquals(lessons.value.head, Vector(3, 4, 5))
    assertEquals(dropped.head, 2)
    assertEquals((lessons.value.flatten ++ dropped).sorted, (2 to 12).toVector)

  test("learning never backpressures, even if a lesson hangs"):
    val passed = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      val passed        = Source(1 to 50)
        .throttle(1, 10.millis)
        .alsoTo(Learn[Int, Int](4, _ => ())(_ => Promise[Option[Int]]().future).to(Sink.ignore))
        .runWith(Sink.seq)
      passed
    assertEquals(passed.value, (1 to 50).toVector)

  test("a failing lesson fails the stage"):
    val ended = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      Source
        .maybe[Int]
        .prepend(Source.single(1))
        .via(Learn[Int, Int](4, _ => ())(_ => Future.failed(IllegalStateException("no such luck"))))
        .runWith(Sink.ignore)
        .failed
        .map(_.getMessage)
    assertEquals(ended.value, "no such luck")
