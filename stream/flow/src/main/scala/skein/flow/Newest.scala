package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow

/** Decouples a source that cannot wait from a slower consumer. */
object Newest:

  /** Keeps the newest element until downstream takes it.
    *
    * '''Emits when''' an element is held and downstream demands. '''Backpressures when''' never; a newer
    * element replaces the held one, which is reported. '''Completes when''' upstream has completed and
    * nothing is held. '''Cancels when''' downstream cancels.
    *
    * @param onReplaced called for every element that was never taken
    */
  def apply[A](onReplaced: A => Unit): Flow[A, A, NotUsed] = Flow[A].conflate: (held, newer) =>
    onReplaced(held)
    newer
