package skein.cli

import scala.collection.mutable.ArrayBuffer
import scala.util.control.NonFatal
import skein.record.{ReadingRow, Record, Topic}
import skein.scenario.{Curve, Kept, Limit, Scenario, Track, Tracks}
import skein.units.*
import skein.units.Decimals.brief
import skein.view.Gauge

/** Computes a scenario's plots and limits from a flight's readings while it runs. For one thread.
  *
  * Series and limits are functions of the whole flight so far, so each computation takes longer than the one
  * before; between two of them is a pause of twenty times the last one's duration. Beyond `most` readings,
  * every second one is dropped.
  *
  * @param vehicles the vehicles' names, in the scenario's order
  * @param most maximum number of readings kept
  */
private[cli] final class ScenarioGauge(
    scenario: Scenario,
    vehicles: Vector[String],
    clock: Clock,
    most: Int = ScenarioGauge.MostReadings
):
  import ScenarioGauge.*

  private type Seen = (Instant, Vector3, Vector3)
  private val seen   = vehicles.map(_ -> ArrayBuffer.empty[Seen]).toMap
  private var count  = 0
  private var toldS  = -1.0
  private var nextAt = Instant.ofNanos(0)
  private var failed = Option.empty[String]

  def gauge: Gauge = Gauge(topic, Every, () => json(), see)

  def see(record: Record): Unit = record match
    case ReadingRow(_, vehicle, state) =>
      for readings <- seen.get(vehicle) do
        readings += ((state.validAt, state.value.positionNed, state.value.velocityNed))
        count += 1
        if count > most then thin()
    case _ => ()

  private[cli] def kept: Int = count

  private def thin(): Unit =
    for readings <- seen.values do
      var at = 0
      readings.filterInPlace: _ =>
        at += 1
        at % 2 == 1
    count = seen.values.map(_.size).sum

  /** The changes since the last call, if there are any. */
  def json(): Option[String] =
    val from = clock.now()
    if from < nextAt || failed.isDefined || scenario.series.isEmpty && scenario.limits.isEmpty then None
    else
      val told =
        try
          val tracks = vehicles.map(name => Track.of(name, "", seen(name).toVector))
          Option.when(seen.values.forall(_.nonEmpty))(tracks).flatMap(Tracks.of).map(message(_).render())
        catch
          // The scenario is user code, which may throw.
          case NonFatal(error) =>
            failed = Some(Option(error.getMessage).getOrElse(error.toString))
            Some(ujson.Obj("series" -> ujson.Arr(), "limits" -> ujson.Arr(), "failed" -> failed.get).render())
      val now = clock.now()
      nextAt = now + now.since(from) * Rest
      told

  private def message(tracks: Tracks): ujson.Obj =
    val series = scenario.series.map: one =>
      val shown = ujson.Obj("title" -> one.title, "points" -> points(one.curve(tracks)))
      for bound <- one.bound do shown("bound") = ujson.Obj("name" -> bound.name, "value" -> bound.value)
      shown
    toldS = tracks.lastS
    ujson.Obj(
      "series" -> ujson.Arr.from(series),
      "limits" -> ujson.Arr.from(scenario.limits.map(limit(_, tracks)))
    )

  /** The points after those already sent, a tenth of a second apart; NaN is omitted. */
  private def points(curve: Curve): ujson.Arr =
    val fresh = curve.points.drop(
      1 + curve.points.lastIndexWhere(_._1 <= toldS)
    ).reverse.grouped(PointEvery).map(_.head)
    ujson.Arr.from(fresh.take(MostPoints).toVector.reverse.collect {
      case (at, value) if value.isFinite =>
        ujson.Arr(at, value)
    })

  private def limit(limit: Limit, tracks: Tracks): ujson.Obj =
    val broken = limit.violations(tracks)
    val shown  = ujson.Obj("text" -> limit.text, "stretches" -> broken.size)
    limit.kept.foreach:
      case Kept.Above(least) => shown("altitudeM") = least
      case Kept.Below(most)  => shown("altitudeM") = most
      case _                 => ()
    val sign = if limit.isLeast then 1 else -1
    for worst <- broken.minByOption(_.worst * sign) do
      shown("worst") = s"${worst.worst.brief} ${limit.unit}".trim
      shown("worstAtS") = worst.worstAtS
      shown("vehicles") = ujson.Arr.from(worst.vehicles.map(vehicles))
    shown

private[cli] object ScenarioGauge:
  private val Every = Span.ofMillis(500)

  /** Pause after a computation, as a multiple of its duration. */
  private val Rest = 20

  /** Number of the tracks' instants from one point to the next. */
  private val PointEvery = 5

  /** Maximum number of points in one message: half a minute, the length of the page's plots. */
  private val MostPoints = 300

  /** Maximum number of readings kept: 20 vehicles at 20 Hz for five minutes. */
  private val MostReadings = 120_000

  private val number = """{"type":"number"}"""
  private val text   = """{"type":"string"}"""
  private val bound  = s"""{"type":"object","properties":{"name":$text,"value":$number}}"""
  private val pairs  = s"""{"type":"array","items":{"type":"array","items":$number}}"""
  private val series = s"""{"type":"object","properties":{"title":$text,"bound":$bound,"points":$pairs}}"""
  private val limit  =
    s"""{"type":"object","properties":{"text":$text,"stretches":{"type":"integer"},"altitudeM":$number,""" +
      s""""worst":$text,"worstAtS":$number,"vehicles":{"type":"array","items":$text}}}"""

  val topic: Topic = Topic(
    "/skein/scenario",
    "skein.scenario",
    s"""{"title":"skein.scenario","type":"object","properties":{"series":{"type":"array","items":$series},""" +
      s""""limits":{"type":"array","items":$limit},"failed":$text}}"""
  )
