package skein.view

import scala.collection.immutable.{TreeMap, VectorMap}

/** Messages that wait for one viewer. The newest messages are kept: beyond the limits, the oldest is dropped,
  * first of the subscription with too many messages, then of all. Notices of the server are few, one for each
  * key, and are sent before everything else.
  *
  * @param lost number of messages dropped since the viewer connected
  */
final case class Outbox[A] private (
    limits: ViewerLimits,
    notices: VectorMap[String, A],
    waiting: TreeMap[Long, Outbox.Waiting[A]],
    places: Map[Long, Vector[Long]],
    bytes: Long,
    next: Long,
    lost: Long
):
  def isEmpty: Boolean = notices.isEmpty && waiting.isEmpty

  /** Replaces a waiting notice with this key; the new one is sent last. */
  def noticed(key: String, message: A): Outbox[A] = copy(notices = (notices - key).updated(key, message))

  /** @param most maximum number of waiting messages of this subscription */
  def offered(subscription: Long, message: A, size: Int, most: Int = limits.waiting): Outbox[A] =
    val places2 = places.updated(subscription, places.getOrElse(subscription, Vector.empty) :+ next)
    copy(
      waiting = waiting.updated(next, Outbox.Waiting(subscription, message, size)),
      places = places2,
      bytes = bytes + size,
      next = next + 1
    ).bounded(subscription, most)

  /** The next message to send, and the remaining outbox. */
  def taken: Option[(A, Outbox[A])] =
    notices.headOption match
      case Some((key, message)) => Some((message, copy(notices = notices - key)))
      case None                 => waiting.headOption.map((place, first) => (first.message, without(place)))

  def unsubscribed(subscription: Long): Outbox[A] =
    places.getOrElse(subscription, Vector.empty).foldLeft(this)(_.without(_))

  def emptied: Outbox[A] = copy(waiting = TreeMap.empty, places = Map.empty, bytes = 0)

  private def bounded(subscription: Long, most: Int): Outbox[A] =
    val own = places(subscription)
    if own.size > most then losing(own.head).bounded(subscription, most)
    else if bytes > limits.waitingBytes && waiting.size > 1 then
      val smaller = losing(waiting.firstKey)
      if smaller.places.contains(subscription) then smaller.bounded(subscription, most) else smaller
    else this

  private def losing(place: Long) = without(place).copy(lost = lost + 1)

  /** @param place key of the first waiting message of a subscription */
  private def without(place: Long): Outbox[A] =
    val gone = waiting(place)
    val left = places(gone.subscription).tail
    copy(
      waiting = waiting - place,
      places = if left.isEmpty then places - gone.subscription else places.updated(gone.subscription, left),
      bytes = bytes - gone.size
    )

object Outbox:
  final case class Waiting[A](subscription: Long, message: A, size: Int)

  def empty[A](limits: ViewerLimits): Outbox[A] =
    Outbox(limits, VectorMap.empty, TreeMap.empty, Map.empty, bytes = 0, next = 0, lost = 0)
