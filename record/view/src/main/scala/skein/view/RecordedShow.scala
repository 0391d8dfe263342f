package skein.view

import org.apache.pekko.http.scaladsl.model.ws.BinaryMessage
import skein.record.{FlightRow, FlightTopics, ImagingSensor, McapRecording, Record, VehicleRow}
import skein.scene.Scene
import skein.units.Instant

/** A recording that is played.
  *
  * @param rows the recording's rows in order, with their numbers
  * @param scene the scene of the flight's world
  */
final class RecordedShow(
    id: String,
    vehicles: Vector[String],
    rows: Vector[(Long, Record)],
    limits: ViewerLimits = ViewerLimits.OfRecording,
    scene: Scene = Scene.Empty
) extends Show(id, vehicles, rows.flatMap((_, row) => ImagingSensor.of(row)).distinct, limits):

  private val start = FlightTopics.startOf(rows)

  /** The time at which each row was known: of a row without a time, that of the row before. */
  private val times: Array[Instant] =
    rows.iterator
      .scanLeft(start)((known, row) => FlightTopics.knownAt(row._2).getOrElse(known).max(known))
      .drop(1)
      .toArray

  private var playback = Playback(start, times.lastOption.getOrElse(start))
  private var topics   = begun
  private var next     = 0
  private var told     = Option.empty[Protocol.Status]

  begin()
  showUntil(start)

  override def recorded: Option[(Instant, Instant)] = Some((playback.start, playback.end))

  def turn(now: Instant): Unit = synchronized:
    val position = playback.position(now)
    showUntil(position)
    notice("time", BinaryMessage.Strict(Protocol.timeIs(position)))
    val status = statusAt(now)
    if !told.contains(status) then tell(now, seeked = false, request = "")

  def control(wanted: ClientMessage.Playback, now: Instant): Either[String, Unit] = synchronized:
    val before = playback.position(now)
    playback = playback.controlled(wanted.playing, wanted.speed, wanted.seek, now)
    val position = playback.position(now)
    val seeked   = position != before
    // Viewers must learn of the seek before the rows that follow.
    if position < before then forget()
    tell(now, seeked, wanted.request)
    if position < before then begin()
    showUntil(position)
    Right(())

  override protected def greet(viewer: Viewer, now: Instant): Unit =
    viewer.notice("playback", BinaryMessage.Strict(Protocol.playbackState(state(now, seeked = false, ""))))

  private def begin(): Unit =
    topics = begun
    next = 0
    topics.opening.foreach(publish)

  private def begun = FlightTopics(vehicles, start, scene = scene, form = ImagePreviews)

  /** Shows all rows up to a time; of skipped images and clouds only the newest. */
  private def showUntil(time: Instant): Unit =
    val from = next
    while next < rows.size && times(next) <= time do next += 1
    val newest = (from until next).flatMap(at => ImagingSensor.of(rows(at)._2).map(_ -> at)).toMap
    for at <- from until next if ImagingSensor.of(rows(at)._2).forall(newest(_) == at) do
      topics.of(rows(at)._1, rows(at)._2).foreach(publish)

  private def statusAt(now: Instant) =
    if playback.hasEnded(now) then Protocol.Status.Ended
    else if playback.playing then Protocol.Status.Playing
    else Protocol.Status.Paused

  private def state(now: Instant, seeked: Boolean, request: String) =
    Protocol.Playing(statusAt(now), playback.position(now), playback.speed, seeked, request)

  private def tell(now: Instant, seeked: Boolean, request: String): Unit =
    told = Some(statusAt(now))
    // Messages after a seek must not replace its notice: the seek is reported once.
    val key = if seeked then "jump" else "playback"
    notice(key, BinaryMessage.Strict(Protocol.playbackState(state(now, seeked, request))))

object RecordedShow:
  /** @param rows the rows of one recording, its heading first
    * @param scene makes the scene of the flight's world from the recording's parameters
    */
  def of(
      rows: Vector[(Long, Record)],
      scene: Map[String, String] => Scene = _ => Scene.Empty
  ): RecordedShow = RecordedShow(
    rows.collectFirst { case (_, flight: FlightRow) => flight.id }.getOrElse("flight"),
    rows.collect { case (_, vehicle: VehicleRow) => vehicle.name },
    rows,
    scene = McapRecording.sceneOf(rows, scene)
  )
