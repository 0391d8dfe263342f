package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.units.*

/** Tells somebody at the end of a flight what must not get lost: again, after a pause, until the answer is
  * certain.
  */
private[loop] object UntilCertain:

  /** How often they are told, at most. */
  val Attempts = 20

  /** Pause before they are told again. */
  val Pause: Span = Span.ofMillis(500)

  /** What the last attempt came to; one that fails is not certain. */
  def apply[A](
      attempt: => Future[A],
      attempts: Int = Attempts,
      pause: Span = Pause
  )(isCertain: A => Boolean)(using
      system: ActorSystem
  ): Future[A] =
    import system.dispatcher
    attempt.transformWith: result =>
      if attempts == 1 || result.toOption.exists(isCertain) then Future.fromTry(result)
      else after(pause.toDuration, system.scheduler)(UntilCertain(attempt, attempts - 1, pause)(isCertain))
