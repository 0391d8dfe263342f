package skein.vtime.example

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.TimeoutException
import scala.concurrent.duration.*
import skein.vtime.VirtualTime

class SilenceSuite extends munit.FunSuite:

  test("a sensor that falls silent after ten minutes is noticed within nine eighths of a second"):
    val run = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      Source
        .tick(0.seconds, 100.millis, "reading")
        .takeWithin(10.minutes)
        .concat(Source.maybe)
        .idleTimeout(1.second)
        .runWith(Sink.ignore)
        .failed
    assert(run.value.isInstanceOf[TimeoutException])
    assertEquals(run.duration, 10.minutes + 1.second)
