package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.units.*
import skein.vtime.VirtualTime

class JoinLatestSuite extends munit.FunSuite:

  /** Emissions with their times in ms, for arrivals at times in ms; and the stale values. */
  private def joined(patienceMs: Double)(arrivals: (Int, (String, Int))*) =
    var stale = Vector.empty[(String, Int)]
    val run   = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      val clock         = Clock.ofNanos(VirtualTime.clock(system))
      val start         = clock.now()
      val join          =
        JoinLatest[String, Int](Set("a", "b"), Span.ofMillis(patienceMs))(_ > _, (k, v) => stale :+= (k, v))
      Source(arrivals)
        .mapAsync(arrivals.size)((at, arrival) => after(at.millis)(Future.successful(arrival)))
        .concat(Source.maybe)
        .via(join)
        .map(values => (clock.now().since(start).toNanos / 1_000_000, values))
        .takeWithin(1.second)
        .runWith(Sink.seq)
    (run.value, stale)

  test("with patience, a join waits until every key is renewed"):
    val (emitted, _) =
      joined(patienceMs = 50)(0 -> ("a", 1), 10 -> ("b", 1), 100 -> ("a", 2), 130 -> ("b", 2))
    assertEquals(emitted, Seq(10L -> Map("a" -> 1, "b" -> 1), 130L -> Map("a" -> 2, "b" -> 2)))

  test("when its patience has elapsed, a join emits the values received so far"):
    val (emitted, _) =
      joined(patienceMs = 50)(0 -> ("a", 1), 10 -> ("b", 1), 100 -> ("a", 2), 170 -> ("b", 2))
    assertEquals(
      emitted,
      Seq(10L -> Map("a" -> 1, "b" -> 1), 150L -> Map("a" -> 2, "b" -> 1), 220L -> Map("a" -> 2, "b" -> 2))
    )

  test("without patience, a join emits at every newer value once it has seen all keys"):
    val (emitted, _) = joined(patienceMs = 0)(0 -> ("a", 1), 10 -> ("a", 2), 20 -> ("b", 5), 30 -> ("a", 3))
    assertEquals(emitted, Seq(20L -> Map("a" -> 2, "b" -> 5), 30L -> Map("a" -> 3, "b" -> 5)))

  test("a late value never overrides a newer one and is reported"):
    val (emitted, stale) =
      joined(patienceMs = 0)(0 -> ("a", 2), 10 -> ("b", 5), 20 -> ("b", 4), 30 -> ("a", 3))
    assertEquals(emitted, Seq(10L -> Map("a" -> 2, "b" -> 5), 30L -> Map("a" -> 3, "b" -> 5)))
    assertEquals(stale, Vector("b" -> 4))

  test("without patience, a join does not wait for simultaneous values either"):
    val (emitted, _) = joined(patienceMs = 0)(0 -> ("a", 1), 0 -> ("b", 1), 10 -> ("a", 2), 10 -> ("b", 2))
    assertEquals(
      emitted,
      Seq(0L -> Map("a" -> 1, "b" -> 1), 10L -> Map("a" -> 2, "b" -> 1), 10L -> Map("a" -> 2, "b" -> 2))
    )
