package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.Future

/** Gives elements to a learner beside a stream. */
object Learn:

  /** Gives what has come to `learn`, one lesson at a time; what comes meanwhile waits for the next lesson.
    *
    * '''Emits when''' a lesson has made something and downstream demands. '''Backpressures when''' never;
    * beyond `most` elements that wait, the oldest is dropped, which is reported. '''Completes when'''
    * upstream has completed and the last lesson is over. '''Cancels when''' downstream cancels. '''Fails
    * when''' a lesson does.
    *
    * @param most elements of a lesson
    * @param onDropped called for every element that is in no lesson
    * @param learn from elements in the order in which they came; not on the stream's thread
    */
  def apply[A, B](
      most: Int,
      onDropped: A => Unit
  )(learn: Vector[A] => Future[Option[B]]): Flow[A, B, NotUsed] =
    require(most > 0, s"expected lessons of at least one element, came $most")
    Flow[A]
      .conflateWithSeed(Vector(_)): (held, next) =>
        val kept = held.drop(held.size - most + 1)
        held.take(held.size - kept.size).foreach(onDropped)
        kept :+ next
      .mapAsync(1)(learn)
      .mapConcat(_.toList)
