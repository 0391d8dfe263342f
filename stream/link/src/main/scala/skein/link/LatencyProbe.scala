package skein.link

import org.apache.pekko.stream.scaladsl.Source
import scala.concurrent.duration.Duration
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Success, Try}
import skein.units.{Clock, Span}

/** Measures round trips to any peer that answers. */
object LatencyProbe:

  /** Sends a request each `period`, whether or not the one before has been answered, and emits the round
    * trips in the order of sending; for a failed request its failure.
    *
    * @param request sends a request and completes with its answer; it has a timeout of its own
    * @param maxUnanswered maximum number of requests in progress; at this number none is sent
    */
  def roundTrips(
      request: () => Future[?],
      period: Span,
      samples: Int,
      clock: Clock,
      maxUnanswered: Int = 64
  ): Source[Try[Span], Any] =
    Source
      .tick(Duration.Zero, period.toDuration, ())
      .take(samples)
      .mapAsync(maxUnanswered): _ =>
        val sentAt = clock.now()
        request().transform(answer => Success(answer.map(_ => clock.now().since(sentAt))))(using
          ExecutionContext.parasitic
        )
