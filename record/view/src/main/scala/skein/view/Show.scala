package skein.view

import org.apache.pekko.http.scaladsl.model.ws.{Message, TextMessage}
import org.apache.pekko.util.ByteString
import scala.collection.immutable.VectorMap
import scala.collection.mutable
import scala.util.control.NonFatal
import skein.record.{FlightMessage, FlightTopics, ImagingSensor, Topic}
import skein.units.Instant

/** One flight for viewers: its channels, the newest messages, and the viewers. The newest message of each
  * topic and vehicle is kept, so that a viewer that connects later, or while time is stopped, has the whole
  * picture.
  *
  * All methods may be called from any thread; they only wait for each other.
  *
  * @param id the flight's identifier
  * @param sensors the sensors whose images and clouds are shown
  * @param more topics beside those of every flight
  */
abstract class Show private[view] (
    val id: String,
    vehicles: Vector[String],
    sensors: Vector[ImagingSensor],
    val limits: ViewerLimits,
    more: Vector[Topic] = Vector.empty
):
  val channels: Vector[FoxgloveChannel] =
    (FlightTopics.all(vehicles) ++ sensors.flatMap(FlightTopics.of(_, ImagePreviews)) ++ more).zipWithIndex
      .map((topic, at) => FoxgloveChannel(at + 1L, topic))

  private val byTopic = channels.map(channel => channel.topic.name -> channel.id).toMap
  private val latest  = channels.filter(_.topic.newestOnly).map(_.id).toSet
  private val newest  = mutable.Map.empty[Long, VectorMap[String, Shown]]
  private val viewers = mutable.Set.empty[Viewer]

  private final class Shown(message: FlightMessage):
    lazy val payload: ByteString = ByteString.fromArrayUnsafe(message.bytes)
    def at: Instant              = message.known

  /** Begin and end of a recording; None during a flight. */
  def recorded: Option[(Instant, Instant)] = None

  def controls: Map[FlightControl, () => Unit] = Map.empty

  /** Sends new messages to the viewers. To be called about forty times per second. */
  def turn(now: Instant): Unit

  /** Calls [[turn]]. If it fails, viewers get the reason, and the next turn follows. */
  private[view] final def attempt(now: Instant): Unit =
    try turn(now)
    catch
      case NonFatal(error) =>
        notice("failed", TextMessage.Strict(Protocol.warning("failed", s"not shown: $error")))

  def control(playback: ClientMessage.Playback, now: Instant): Either[String, Unit]

  private[view] def entered(viewer: Viewer, now: Instant): Unit = synchronized:
    viewers += viewer
    viewer.notice("info", TextMessage.Strict(Protocol.serverInfo(s"Skein: $id", Show.session, recorded)))
    viewer.notice("advertise", TextMessage.Strict(Protocol.advertise(channels)))
    greet(viewer, now)

  private[view] def left(viewer: Viewer): Unit = synchronized(viewers -= viewer): Unit

  private[view] def subscribed(viewer: Viewer, subscription: Long, channel: Long): Unit = synchronized:
    for shown <- newest.get(channel).toSeq.flatMap(_.values) do
      viewer.offer(subscription, shown.at, shown.payload, latest(channel))

  /** Sends the first messages to a new viewer. */
  protected def greet(viewer: Viewer, now: Instant): Unit = ()

  protected def publish(message: FlightMessage): Unit = synchronized:
    for channel <- byTopic.get(message.topic) do
      val shown = Shown(message)
      newest(channel) = newest.getOrElse(channel, VectorMap.empty).updated(message.key, shown)
      for
        viewer       <- viewers
        subscription <- viewer.subscriptionsTo(channel)
      do viewer.offer(subscription, shown.at, shown.payload, latest(channel))

  protected def forget(): Unit = synchronized:
    newest.clear()
    viewers.foreach(_.empty())

  protected def notice(key: String, message: Message): Unit = synchronized:
    viewers.foreach(_.notice(key, message))

  def watching: Int = synchronized(viewers.size)

object Show:
  /** Identifies the process to viewers that reconnect. */
  private[view] val session: String = java.util.UUID.randomUUID().toString
