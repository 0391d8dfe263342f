package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow

/** Copies the elements of a stream to a function. */
object Tap:

  /** Calls `take`, which must not block, with every element, and passes the element on. Unlike `wireTap` it
    * never drops.
    *
    * '''Emits when''' an element arrives. '''Backpressures when''' downstream backpressures. '''Completes
    * when''' upstream completes. '''Cancels when''' downstream cancels.
    */
  def apply[A](take: A => Unit): Flow[A, A, NotUsed] = Flow[A].map: element =>
    take(element)
    element
