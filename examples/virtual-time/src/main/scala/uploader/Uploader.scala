package uploader

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.{RetrySupport, after}
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.Future
import scala.concurrent.duration.*

/** Sends samples to a server in batches, and retries while the server is unavailable. Plain Pekko; nothing
  * here depends on virtual time.
  */
object Uploader extends RetrySupport:
  val MostInBatch = 100
  val LongestWait = 5.seconds
  val Patience    = 2.seconds
  val Attempts    = 20
  val ShortPause  = 1.second
  val LongPause   = 5.minutes

  /** Emits the size of every batch once the server has it.
    *
    * @param upload sends one batch; a call that takes longer than [[Patience]] counts as failed
    */
  def apply(upload: Seq[Int] => Future[Unit])(using system: ActorSystem): Flow[Int, Int, NotUsed] =
    import system.dispatcher
    given org.apache.pekko.actor.Scheduler    = system.scheduler
    def inTime(batch: Seq[Int]): Future[Unit] =
      val late = after(Patience)(Future.failed(RuntimeException("no answer")))
      Future.firstCompletedOf(Seq(upload(batch), late))
    Flow[Int]
      .groupedWithin(MostInBatch, LongestWait)
      .mapAsync(1): batch =>
        retry(() => inTime(batch), Attempts, ShortPause, LongPause, randomFactor = 0.2).map(_ => batch.size)
