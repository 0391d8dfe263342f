package skein.view

import skein.record.{Flight, FlightTopics, Record, Vehicle}
import skein.units.Instant

/** A recording, played.
  *
  * @param rows
  *   in their order, with their numbers
  */
final class RecordedShow(
    id: String,
    vehicles: Vector[String],
    rows: Vector[(Long, Record)],
    limits: Limits = Limits()
) extends Show(id, FlightTopics.all(vehicles), limits):

  /** When each row was known: of one that says no time, that of the row before. */
  private val times: Array[Instant] =
    val first = rows.iterator.flatMap((_, record) => FlightTopics.knownAt(record)).nextOption().getOrElse(
      Instant.ofNanos(0)
    )
    rows.iterator
      .scanLeft(first)((known, row) => FlightTopics.knownAt(row._2).getOrElse(known).max(known))
      .drop(1)
      .toArray

  private val start    = times.headOption.getOrElse(Instant.ofNanos(0))
  private var playback = Playback(start, times.lastOption.getOrElse(start))
  private var topics   = FlightTopics(vehicles, start)
  private var next     = 0
  private var told     = Option.empty[Protocol.Status]

  rewind()
  showUntil(start)

  def recorded: Option[(Instant, Instant)] = Some((playback.start, playback.end))

  def turn(now: Instant): Unit = synchronized:
    val position = playback.position(now)
    showUntil(position)
    notice("time", ServerBytes(Protocol.timeIs(position)))
    val status = statusAt(now)
    if !told.contains(status) then tell(now, seeked = false, request = "")

  def control(wanted: ClientMessage.Playback, now: Instant): Either[String, Unit] = synchronized:
    val before = playback.position(now)
    playback = playback.controlled(wanted.playing, wanted.speed, wanted.seek, now)
    val position = playback.position(now)
    val seeked   = position != before
    if position < before then rewind()
    tell(now, seeked, wanted.request)
    showUntil(position)
    Right(())

  protected def greet(viewer: Viewer): Unit =
    viewer.notice("playback", ServerBytes(Protocol.playbackState(state(playback.since, seeked = false, ""))))

  private def rewind(): Unit =
    forget()
    topics = FlightTopics(vehicles, start)
    next = 0
    topics.opening.foreach(publish)

  private def showUntil(time: Instant): Unit =
    while next < rows.size && times(next) <= time do
      val (number, record) = rows(next)
      topics.of(number, record).foreach(publish)
      next += 1

  private def statusAt(now: Instant) =
    if playback.hasEnded(now) then Protocol.Status.Ended
    else if playback.playing then Protocol.Status.Playing
    else Protocol.Status.Paused

  private def state(now: Instant, seeked: Boolean, request: String) =
    Protocol.Playing(statusAt(now), playback.position(now), playback.speed, seeked, request)

  private def tell(now: Instant, seeked: Boolean, request: String): Unit =
    told = Some(statusAt(now))
    notice("playback", ServerBytes(Protocol.playbackState(state(now, seeked, request))))

object RecordedShow:
  /** @param rows
    *   of one recording, its heading first
    */
  def of(rows: Vector[(Long, Record)]): RecordedShow = RecordedShow(
    rows.collectFirst { case (_, flight: Flight) => flight.id }.getOrElse("flight"),
    rows.collect { case (_, vehicle: Vehicle) => vehicle.name },
    rows
  )
