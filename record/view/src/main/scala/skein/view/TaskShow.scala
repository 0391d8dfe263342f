package skein.view

import java.util.concurrent.atomic.AtomicReference
import scala.collection.immutable.VectorMap
import skein.record.{FlightMessage, Topic}
import skein.units.Instant

/** Shows work other than a flight: a search, a sweep, a training. The one who does the work publishes what is
  * new, from any thread, and waits for nothing; of what is said again before a viewer's turn, the newest is
  * shown.
  *
  * @param id of the work
  */
final class TaskShow(id: String, limits: ViewerLimits = ViewerLimits())
    extends Show(id, TaskShow.topics, limits):
  private val said = AtomicReference(VectorMap.empty[String, (Topic, String)])

  /** How far it is.
    *
    * @param unit of what is counted, for example `episodes`
    * @param line what else is to be said now
    */
  def progress(title: String, done: Long, expected: Long, unit: String, line: String): Unit = say(
    TaskShow.progress,
    title,
    ujson.Obj(
      "title"    -> title,
      "done"     -> done.toDouble,
      "expected" -> expected.toDouble,
      "unit"     -> unit,
      "line"     -> line
    )
  )

  /** A line that grows; one with the same title takes its place.
    *
    * @param x name of the axis, with its unit
    * @param points the oldest of too many are thinned out
    */
  def curve(title: String, x: String, y: String, points: Vector[(Double, Double)]): Unit = say(
    TaskShow.curve,
    title,
    ujson.Obj(
      "title"  -> title,
      "x"      -> x,
      "y"      -> y,
      "points" -> ujson.Arr.from(TaskShow.thinned(points).map((x, y) => ujson.Arr(x, y)))
    )
  )

  /** A map that grows; one with the same title takes its place.
    *
    * @param rows of its cells, those of the lowest y first; absent cells are not known yet, and so are rows
    *   at the end
    */
  def landscape(
      title: String,
      x: TaskShow.Axis,
      y: TaskShow.Axis,
      rows: Vector[Vector[Option[Double]]]
  ): Unit =
    def axis(axis: TaskShow.Axis) = ujson.Obj("name" -> axis.name, "values" -> ujson.Arr.from(axis.values))
    say(
      TaskShow.landscape,
      title,
      ujson.Obj(
        "title" -> title,
        "x"     -> axis(x),
        "y"     -> axis(y),
        "rows"  -> ujson.Arr.from(rows.map(row =>
          ujson.Arr.from(row.map(_.filter(_.isFinite).fold[ujson.Value](ujson.Null)(ujson.Num(_))))
        ))
      )
    )

  private def say(topic: Topic, title: String, json: => ujson.Value): Unit =
    val text = json.render()
    said.updateAndGet(_.updated(s"${topic.name} $title", (topic, text))): Unit

  def recorded: Option[(Instant, Instant)] = None

  protected def greet(viewer: Viewer): Unit = ()

  def turn(now: Instant): Unit =
    for (key, (topic, json)) <- said.getAndSet(VectorMap.empty) do
      publish(FlightMessage.json(topic.name, key, now, now)(json))
    notice("time", ServerBytes(Protocol.timeIs(now)))

  def control(playback: ClientMessage.Playback, now: Instant): Either[String, Unit] =
    Left("what is being done cannot be played")

object TaskShow:
  /** @param name with its unit
    */
  final case class Axis(name: String, values: Vector[Double])

  private val number = """{"type":"number"}"""
  private val text   = """{"type":"string"}"""

  private def topic(name: String, properties: (String, String)*) =
    val listed = properties.map((name, kind) => s""""$name":$kind""").mkString(",")
    Topic(
      s"/skein/$name",
      s"skein.$name",
      s"""{"title":"skein.$name","type":"object","properties":{$listed}}"""
    )

  private def listOf(kind: String) = s"""{"type":"array","items":$kind}"""

  private val axis = s"""{"type":"object","properties":{"name":$text,"values":${listOf(number)}}}"""

  private val progress =
    topic("progress", "title" -> text, "done" -> number, "expected" -> number, "unit" -> text, "line" -> text)

  private val curve =
    topic("curve", "title" -> text, "x" -> text, "y" -> text, "points" -> listOf(listOf(number)))

  private val landscape = topic(
    "landscape",
    "title" -> text,
    "x"     -> axis,
    "y"     -> axis,
    "rows"  -> listOf(listOf("""{"type":["number","null"]}"""))
  )

  private val topics = Vector(progress, curve, landscape)

  /** Points of a curve that are sent at the most. */
  private[view] val MostPoints = 1000

  /** Every second, fourth, … of them, and the last. */
  private[view] def thinned[A](points: Vector[A]): Vector[A] =
    if points.size <= MostPoints then points
    else
      val every = Iterator.iterate(2)(_ * 2).find(points.size / _ < MostPoints).get
      points.indices.by(every).map(points).toVector ++ Option.when(
        (points.size - 1) % every != 0
      )(points.last)
