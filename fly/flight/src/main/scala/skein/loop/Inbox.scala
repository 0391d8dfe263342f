package skein.loop

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.QueueOfferResult
import org.apache.pekko.stream.scaladsl.Source
import scala.concurrent.{Future, Promise}
import skein.signal.{Kinematics, Stamped}

/** The messages of one other vehicle. Thread-safe.
  *
  * @param onDropped called for each message that waited for too long behind other messages
  */
private final class Inbox(
    isNewer: (Stamped[Kinematics], Stamped[Kinematics]) => Boolean,
    onDropped: Reading => Unit
):
  private val first  = Promise[Reading]()
  private var newest = Option.empty[Reading]
  private var reader = (_: Reading) => ()

  def put(message: Reading): Unit =
    synchronized:
      if newest.forall(held => isNewer(message.state, held.state)) then newest = Some(message)
      reader(message)
    first.trySuccess(message): Unit

  /** The newest message so far; if there is none yet, the first one. */
  def read(): Future[Reading] =
    synchronized(newest).fold(first.future)(Future.successful)

  /** The newest message so far, and the messages from now on, in the order of their arrival. One graph may
    * run it.
    */
  def messages: Source[Reading, NotUsed] =
    Source
      .queue[Reading](Inbox.Waiting)
      .mapMaterializedValue: queue =>
        synchronized:
          reader = message => if queue.offer(message) == QueueOfferResult.Dropped then onDropped(message)
          newest.foreach(reader)
        NotUsed

private object Inbox:
  /** Maximum number of messages that wait for a slow graph; a further one is dropped. */
  val Waiting = 64
