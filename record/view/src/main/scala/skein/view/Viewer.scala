package skein.view

import org.apache.pekko.http.scaladsl.model.ws.{BinaryMessage, Message, TextMessage}
import org.apache.pekko.util.ByteString
import skein.units.Instant

/** A viewer: its subscriptions, and its waiting messages. From any thread.
  *
  * @param wake called when a message waits again after [[take]] has found none
  */
private[view] final class Viewer(limits: ViewerLimits, channels: Set[Long], wake: () => Unit):
  @volatile private var subscriptions = Subscriptions.none(limits, channels)
  private var outbox                  = Outbox.empty[Message](limits)
  private var idle                    = false
  private var toldLost                = 0L

  def subscriptionsTo(channel: Long): Iterable[Long] = subscriptions.of(channel)

  def subscribe(subscription: Long, channel: Long): Either[String, Unit] = synchronized:
    subscriptions.added(subscription, channel).map(subscriptions = _)

  def unsubscribe(subscription: Long): Either[String, Unit] = synchronized:
    subscriptions.removed(subscription).map: left =>
      subscriptions = left
      outbox = outbox.unsubscribed(subscription)

  /** @param newestOnly whether waiting messages of this subscription become useless */
  def offer(subscription: Long, logTime: Instant, payload: ByteString, newestOnly: Boolean = false): Unit =
    val data = Protocol.messageData(subscription, logTime, payload)
    val most = if newestOnly then 1 else limits.waiting
    put(_.offered(subscription, BinaryMessage.Strict(data), data.length, most))

  def empty(): Unit = synchronized { outbox = outbox.emptied }

  def notice(key: String, message: Message): Unit = put(_.noticed(key, message))

  def lost: Long = synchronized(outbox.lost)

  /** The next message. Lost messages are reported before it. */
  def take(): Option[Message] = synchronized:
    if outbox.lost > toldLost then
      toldLost = outbox.lost
      Some(TextMessage.Strict(Protocol.warning(
        "lost",
        s"$toldLost older messages are not shown: more came than may wait for this viewer"
      )))
    else
      outbox.taken match
        case Some((message, rest)) =>
          outbox = rest
          Some(message)
        case None =>
          idle = true
          None

  private def put(change: Outbox[Message] => Outbox[Message]): Unit =
    val wakes = synchronized:
      outbox = change(outbox)
      val was = idle
      idle = false
      was
    if wakes then wake()
