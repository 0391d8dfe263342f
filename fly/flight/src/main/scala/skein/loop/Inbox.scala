package skein.loop

import java.util.concurrent.atomic.AtomicReference
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
  private val newest = AtomicReference(Option.empty[Reading])
  private val reader = AtomicReference((_: Reading) => ())

  def put(message: Reading): Unit =
    newest.updateAndGet: held =>
      if held.exists(one => !isNewer(message.state, one.state)) then held else Some(message)
    first.trySuccess(message)
    reader.get()(message)

  /** The newest message so far; if there is none yet, the first one. */
  def read(): Future[Reading] =
    newest.get.fold(first.future)(Future.successful)

  /** The messages from now on, in the order of their arrival. One graph may run it. */
  def messages: Source[Reading, NotUsed] =
    Source
      .queue[Reading](Inbox.Waiting)
      .mapMaterializedValue: queue =>
        reader.set(message => if queue.offer(message) == QueueOfferResult.Dropped then onDropped(message))
        NotUsed

private object Inbox:
  /** Maximum number of messages that wait for a slow graph; a further one is dropped. */
  val Waiting = 64
