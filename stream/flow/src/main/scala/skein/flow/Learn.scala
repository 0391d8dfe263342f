package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.Future

/** Feeds a stream's elements to a learner that works concurrently with the stream. */
object Learn:

  /** Passes the elements received so far to `learn`, one lesson at a time; elements received meanwhile wait
    * for the next lesson.
    *
    * '''Emits when''' a lesson has a result and downstream demands. '''Backpressures when''' never; beyond
    * `most` waiting elements, the oldest is dropped and reported. '''Completes when''' upstream has completed
    * and the last lesson has ended. '''Cancels when''' downstream cancels. '''Fails when''' a lesson does.
    *
    * @param most maximum number of elements in a lesson
    * @param onDropped called for every element that is in no lesson
    * @param learn processes a lesson, whose elements are in the order of arrival; it must not work on the
    *   stream's thread
    */
  def apply[A, B](
      most: Int,
      onDropped: A => Unit
  )(learn: Vector[A] => Future[Option[B]]): Flow[A, B, NotUsed] =
    require(most > 0, s"expected lessons of at least one element, got $most")
    Flow[A]
      .conflateWithSeed(Vector(_)): (held, next) =>
        val kept = held.drop(held.size - most + 1)
        held.take(held.size - kept.size).foreach(onDropped)
        kept :+ next
      .mapAsync(1)(learn)
      .mapConcat(_.toList)
