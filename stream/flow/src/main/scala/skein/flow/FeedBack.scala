package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow

/** The feedback edge of a cyclic graph. */
object FeedBack:

  /** Carries the newest value of each key back upstream. It always accepts, so the cycle cannot deadlock, and
    * holds at most one value per key, so it cannot grow; a replaced value was outdated before anything could
    * use it.
    *
    * '''Emits when''' a value is held and downstream demands. '''Backpressures when''' never. '''Completes
    * when''' upstream completes and nothing is held. '''Cancels when''' downstream cancels.
    */
  def newest[K, A]: Flow[(K, A), (K, A), NotUsed] =
    Flow[(K, A)].conflateWithSeed(Vector(_))(replace).mapConcat(identity)

  /** The held pairs after `next` arrived: it replaces its key's older value, and is last. */
  private[flow] def replace[K, A](held: Vector[(K, A)], next: (K, A)): Vector[(K, A)] =
    held.filterNot(_._1 == next._1) :+ next
