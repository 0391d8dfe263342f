package skein.cli

import skein.observe.NewCommands
import skein.record.*
import skein.units.*
import skein.view.{Feed, Gauge, LiveShow, Shows}

/** Shows the loop of an observed program to viewers while it runs.
  *
  * Computing findings sorts every sample so far, so the next computation starts [[LoopOnShow.Rest]] times the
  * last one's duration later.
  *
  * @param takeNew commands since the last call
  * @param findings the findings so far, in words
  */
private[cli] final class LoopOnShow(
    takeNew: () => Vector[NewCommands],
    findings: () => Vector[String],
    clock: Clock
):
  import LoopOnShow.*

  private val feed   = Feed()
  private var found  = Vector.empty[String]
  private var nextAt = Instant.Epoch

  /** Whether commands have passed since the findings were made. */
  private var isStale = true
  private var isEnded = false

  /** @param what the observed program, for people; `where`: its address */
  def show(shows: Shows, what: String, where: String): Unit =
    val heading = RecordingHeader(flight(Id, Every, where, what, clock.now()), Nil)
    shows.add(LiveShow(heading, feed, Vector(Gauge(topic, Every, () => json()))))

  /** The page keeps what it shows from now on. */
  def end(): Unit =
    isEnded = true
    feed.offer(Ending(clock.now(), EndingKind.Completed, None))

  private[cli] def json(): Option[String] =
    val commands = takeNew()
    val before   = found
    val from     = clock.now()
    isStale ||= commands.nonEmpty
    if isStale && (from >= nextAt || isEnded) then
      found = findings()
      isStale = false
      val now = clock.now()
      nextAt = now + (now.since(from) * Rest).max(FindEvery)
    Option.when(commands.nonEmpty || found != before):
      ujson
        .Obj("vehicles" -> ujson.Arr.from(commands.map(row)), "findings" -> ujson.Arr.from(found))
        .render()

  private def row(commands: NewCommands): ujson.Obj =
    val name = if commands.vehicle.isEmpty then "(the first)" else commands.vehicle
    val row  = ujson.Obj("vehicle" -> name)
    for ms <- commands.ownAgeMs do row("ageMs") = ms
    for ms <- commands.sinceOwnMs do row("everyMs") = ms
    for count <- commands.unanswered do row("unanswered") = count
    row

private[cli] object LoopOnShow:
  private val Id        = "observed"
  private val Every     = Span.ofMillis(100)
  private val FindEvery = Span.ofSeconds(1)
  private val Rest      = 20

  /** The heading of what is shown although it is no flight of a loop.
    *
    * @param what it is, for people; `where`: its address
    */
  def flight(id: String, every: Span, where: String, what: String, now: Instant): FlightRow =
    FlightRow(id, "none", "none", 0, every, Span.Zero, "real", Simulator.Other(where), what, "", now)

  private val number  = """{"type":"number"}"""
  private val text    = """{"type":"string"}"""
  private val vehicle =
    s"""{"type":"object","properties":{"vehicle":$text,"ageMs":$number,"everyMs":$number,"unanswered":$number}}"""

  /** The maxima of each vehicle's commands since the last message, and all findings. */
  val topic: Topic = Topic(
    "/skein/observed",
    "skein.observed",
    s"""{"title":"skein.observed","type":"object","properties":{"vehicles":{"type":"array","items":$vehicle},""" +
      s""""findings":{"type":"array","items":$text}}}"""
  )
