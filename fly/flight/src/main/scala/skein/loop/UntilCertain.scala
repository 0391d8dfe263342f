package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.units.*

/** Repeats a flight's final command, which must not get lost, at intervals until its answer is certain. */
private[skein] object UntilCertain:

  /** Maximum number of attempts, the first one included. */
  val Attempts = 20

  /** Pause between two attempts, on the actor system's clock. */
  val Pause: Span = Span.ofMillis(500)

  /** The result of the last attempt; one that fails is not certain. */
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
