package skein.view

import skein.record.{FlightMessage, FlightTopics, RecordingHeader, ImagingSensor, Topic}
import skein.scene.Scene
import skein.units.{Instant, Span}

/** Something besides the records that is shown of a flight, asked for now and then.
  *
  * @param json as the topic's schema says
  */
final case class Gauge(topic: Topic, every: Span, json: () => String)

/** A flight while it flies. Its records come by `feed`; of a camera's images and of a lidar's clouds up to
  * ten a second are shown.
  *
  * @param scene what stands in its world
  * @param sensors whose images and clouds come
  */
final class LiveShow(
    heading: RecordingHeader,
    feed: Feed,
    gauges: Vector[Gauge] = Vector.empty,
    limits: ViewerLimits = ViewerLimits(),
    override val controls: Map[FlightControl, () => Unit] = Map.empty,
    scene: Scene = Scene.Empty,
    sensors: Vector[ImagingSensor] = Vector.empty
) extends Show(heading.flight.id, LiveShow.topics(heading, sensors) ++ gauges.map(_.topic), limits):
  private val topics = FlightTopics(
    heading.vehicles.map(_.name).toVector,
    heading.flight.startedAt,
    scene = scene,
    form = ImagePreviews
  )
  private var number = 0L
  private var asked  = gauges.map(_ => Instant.ofNanos(0))
  private var looked = sensors.map(_ => Instant.ofNanos(0))

  topics.opening.foreach(publish)
  heading.records.foreach(show)

  def recorded: Option[(Instant, Instant)] = None

  protected def greet(viewer: Viewer): Unit = ()

  def turn(now: Instant): Unit =
    Iterator.continually(feed.poll()).takeWhile(_.isDefined).take(LiveShow.MostAtOnce).flatten.foreach(show)
    looked = sensors.zip(looked).map: (sensor, last) =>
      if now.since(last) < LiveShow.LookEvery then last
      else feed.poll(sensor).fold(last)(record => { show(record); now })
    asked = gauges.zip(asked).map: (gauge, last) =>
      if now.since(last) < gauge.every then last
      else
        val json = gauge.json()
        publish(FlightMessage.json(gauge.topic.name, "", now, now)(json))
        now
    notice("time", ServerBytes(Protocol.timeIs(now)))
    if feed.lost > 0 then
      notice("feed", ServerText(Protocol.warning("feed", s"${feed.lost} records were too many to be shown")))

  def control(playback: ClientMessage.Playback, now: Instant): Either[String, Unit] =
    Left("a flight that flies cannot be played")

  private def show(record: skein.record.Record): Unit =
    topics.of(number, record).foreach(publish)
    number += 1

object LiveShow:
  private def topics(heading: RecordingHeader, sensors: Vector[ImagingSensor]) =
    FlightTopics.all(heading.vehicles.map(_.name).toVector) ++ sensors.flatMap(FlightTopics.of(
      _,
      ImagePreviews
    ))

  private val LookEvery = Span.ofMillis(100)

  /** Records of one turn: so that no turn lasts for long. */
  private val MostAtOnce = 8192
