package skein.view

import org.apache.pekko.http.scaladsl.model.ws.{BinaryMessage, TextMessage}
import skein.record.{
  Ending,
  FlightMessage,
  FlightTopics,
  ImagingSensor,
  ReadingRow,
  Record,
  RecordingHeader,
  Topic
}
import skein.scene.Scene
import skein.units.{Instant, Span}

/** Additional data of a flight for viewers, computed at regular intervals.
  *
  * @param json the data in the topic's schema; None if nothing is new
  * @param see called with every record that precedes `json`, on the thread that calls `json`
  */
final case class Gauge(topic: Topic, every: Span, json: () => Option[String], see: Record => Unit = _ => ())

/** A flight while it runs. `feed` supplies its records; of a camera's images and of a lidar's clouds up to
  * ten a second are shown. Its time begins with the first reading and stops when it has ended, and nothing is
  * shown after that.
  *
  * @param scene the scene of the flight's world
  * @param sensors the sensors whose images and clouds are shown
  */
final class LiveShow(
    heading: RecordingHeader,
    feed: Feed,
    gauges: Vector[Gauge] = Vector.empty,
    limits: ViewerLimits = ViewerLimits(),
    override val controls: Map[FlightControl, () => Unit] = Map.empty,
    scene: Scene = Scene.Empty,
    sensors: Vector[ImagingSensor] = Vector.empty
) extends Show(
      heading.flight.id,
      heading.vehicles.map(_.name).toVector,
      sensors,
      limits,
      LiveShow.clock +: gauges.map(_.topic)
    ):
  private val topics = FlightTopics(
    heading.vehicles.map(_.name).toVector,
    heading.flight.startedAt,
    scene = scene,
    form = ImagePreviews
  )
  private var number = 0L
  private var asked  = gauges.map(_ => Instant.ofNanos(0))
  private var looked = sensors.map(_ => Instant.ofNanos(0))
  private var begun  = Option.empty[Instant]
  private var ended  = Option.empty[Instant]

  topics.opening.foreach(publish)
  heading.records.foreach(show)

  def turn(now: Instant): Unit = synchronized:
    if ended.isEmpty then
      Iterator.continually(feed.poll()).takeWhile(_.isDefined).take(LiveShow.MostAtOnce).flatten.foreach(show)
      looked = sensors.zip(looked).map: (sensor, last) =>
        if now.since(last) < LiveShow.LookEvery then last
        else feed.poll(sensor).fold(last)(record => { show(record); now })
      asked = gauges.zip(asked).map: (gauge, last) =>
        // At its end, too, so that it does not stop at an earlier state.
        if now.since(last) < gauge.every && ended.isEmpty then last
        else
          gauge.json().foreach(json => publish(FlightMessage.json(gauge.topic.name, "", now, now)(json)))
          now
    notice("time", BinaryMessage.Strict(Protocol.timeIs(ended.getOrElse(now))))
    if feed.lost > 0 then
      notice(
        "feed",
        TextMessage.Strict(Protocol.warning("feed", s"${feed.lost} records were too many to be shown"))
      )

  def control(playback: ClientMessage.Playback, now: Instant): Either[String, Unit] =
    Left("a flight that flies cannot be played")

  private def show(record: Record): Unit =
    record match
      case reading: ReadingRow if begun.isEmpty =>
        begun = Some(reading.state.sentAt)
        val json = ujson.Obj("startedAtNs" -> reading.state.sentAt.toNanos.toString)
        publish(FlightMessage.json(
          LiveShow.clock.name,
          "",
          reading.state.sentAt,
          reading.state.sentAt
        )(json.render()))
      case ending: Ending => ended = Some(ending.at)
      case _              => ()
    gauges.foreach(_.see(record))
    topics.of(number, record).foreach(publish)
    number += 1

object LiveShow:
  /** The topic of its start time: as text, since JSON numbers are not exact to the nanosecond. */
  private val clock = Topic(
    "/skein/clock",
    "skein.clock",
    """{"title":"skein.clock","type":"object","properties":{"startedAtNs":{"type":"string"}}}"""
  )

  private val LookEvery = Span.ofMillis(100)

  /** Maximum number of records shown per turn, so that no turn takes long. */
  private val MostAtOnce = 8192
