package skein.flight

import java.util.concurrent.atomic.AtomicReference
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.KillSwitches
import org.apache.pekko.stream.scaladsl.{Keep, Sink, Source}
import scala.concurrent.Future
import skein.airsim.{Eyes, Image}
import skein.flow.{Frames, Metronome}
import skein.record.{EventKind, EventSubject}
import skein.rpc.RpcError
import skein.signal.Stamped
import skein.units.*

/** A camera whose images are not used by decisions: they are taken concurrently with the loop, which does not
  * wait for them. Missed images are counted, and reported once a second.
  *
  * @param seen called with each image that is newer than all before; must not block
  * @param imageless called with the reason, if it is closed and no image was received
  */
private[skein] final class FilmedCamera(
    camera: String,
    every: Span,
    eyes: Eyes,
    clock: Clock,
    seen: Stamped[Image] => Unit,
    note: (EventKind, String, Option[EventSubject]) => Unit,
    imageless: String => Unit = _ => ()
)(using system: ActorSystem):
  import system.dispatcher

  private val stop   = KillSwitches.shared(s"film $camera")
  private val source = AlignedCamera(eyes, camera)
  private val missed = AtomicReference(FilmedCamera.Missed(0, "", clock.now()))
  private val ended  = AtomicReference(Future.successful[Done](Done))

  @volatile private var hasSeen = false
  @volatile private var lastWhy = ""

  /** Films periodically until it is closed. */
  def run(): Unit =
    val ticks = Source.fromGraph(Metronome(clock.now(), every, clock)).via(stop.flow)
    val end   = Frames
      .at(ticks, inFlight = 2, source.isNewer)(() => source.image())(skipped)
      .toMat(Sink.foreach { image =>
        hasSeen = true
        seen(image)
      })(Keep.right)
      .run()
    end.failed.foreach(error => note(EventKind.Aborted, s"$camera: $error", None))
    ended.set(end.recover { case _ => Done })

  def close(): Future[Done] =
    stop.shutdown()
    ended.get.map: done =>
      tell(missed.getAndUpdate(_.copy(images = 0)))
      if !hasSeen && lastWhy.nonEmpty then
        val said = s"$camera: no image came: $lastWhy"
        note(EventKind.Refused, said, Some(EventSubject.Camera))
        imageless(said)
      done

  private def skipped(what: Frames.Skipped[Any, Any]): Unit =
    val (images, why) = what match
      case Frames.Skipped.Missed(frames)          => (frames, "the camera is slower")
      case Frames.Skipped.Failed(error: RpcError) => (1, error.message)
      case Frames.Skipped.Failed(error)           => (1, s"$error")
      case Frames.Skipped.Overtaken(_)            => (1, "an image was overtaken")
      case Frames.Skipped.Repeated(_)             => (1, "the same image again")
      case Frames.Skipped.Replaced(_)             => (1, "an image was replaced by a newer one")
    what match
      case Frames.Skipped.Failed(_) => lastWhy = why
      case _                        => if lastWhy.isEmpty then lastWhy = why
    val now    = clock.now()
    val before = missed.getAndUpdate: soFar =>
      if now.since(soFar.since) >= FilmedCamera.TellEvery then FilmedCamera.Missed(0, why, now)
      else soFar.copy(images = soFar.images + images, why = why)
    if now.since(before.since) >= FilmedCamera.TellEvery then
      tell(before.copy(images = before.images + images, why = why))

  private def tell(missed: FilmedCamera.Missed): Unit =
    if missed.images > 0 then
      note(EventKind.Skipped, s"$camera: ${missed.images} images missed; the last, since ${missed.why}", None)

private object FilmedCamera:
  private final case class Missed(images: Int, why: String, since: Instant)

  private val TellEvery = Span.ofSeconds(1)
