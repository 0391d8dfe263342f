package skein.link

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Sink
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success, Try}
import skein.units.Span
import skein.vtime.VirtualTime

/** In virtual time, where every delay is exact. */
class LatencyProbeSuite extends munit.FunSuite:
  private given ExecutionContext = ExecutionContext.parasitic

  private def probe(
      samples: Int,
      maxUnanswered: Int = 64
  )(request: ActorSystem => Int => Future[Any]): Seq[Try[Span]] =
    VirtualTime.run(1): system =>
      given ActorSystem = system
      var sent          = 0
      def next()        =
        sent += 1
        request(system)(sent)
      LatencyProbe
        .roundTrips(() => next(), Span.ofMillis(100), samples, VirtualClock(system), maxUnanswered)
        .runWith(Sink.seq)
    .value

  test("round trips are measured exactly, also while earlier requests are still unanswered"):
    val measured = probe(3): system =>
      i => after((350 - 100 * i).millis, system.scheduler)(Future.unit)
    assertEquals(measured, List(250, 150, 50).map(ms => Success(Span.ofMillis(ms))))

  test("a failed request emits its failure, and the next is sent nevertheless"):
    val refused  = RuntimeException("refused")
    val measured = probe(2)(_ => i => if i == 1 then Future.failed(refused) else Future.unit)
    assertEquals(measured, Seq(Failure(refused), Success(Span.Zero)))

  test("no more requests are in progress than allowed"):
    var open, most = 0
    val measured   = probe(5, maxUnanswered = 2): system =>
      _ =>
        open += 1
        most = most.max(open)
        after(500.millis, system.scheduler)(Future.successful(open -= 1))
    assertEquals(most, 2)
    assertEquals(measured, Seq.fill(5)(Success(Span.ofMillis(500))))
