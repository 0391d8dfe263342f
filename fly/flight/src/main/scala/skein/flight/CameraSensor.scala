package skein.flight

import java.util.concurrent.atomic.{AtomicReference, LongAdder}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.KillSwitches
import org.apache.pekko.stream.scaladsl.{Keep, Sink, Source}
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.airsim.{Eyes, Image, Pixels}
import skein.flow.*
import skein.fusion.{Belief, Fusion, PolarMeasurement}
import skein.port.{Sensor, VehicleError}
import skein.record.EventKind
import skein.scenario.Eye
import skein.signal.{LatencySampler, SplitMix64, Stamped}
import skein.units.*

/** The estimate of an [[Eye]] from its vehicle's camera, as a sensor:
  * `frames ~> recognise ~> fuse ~> newest belief`, concurrently with the loop, which does not wait for it.
  * Images use separate connections. Every image without a result is recorded as an event.
  *
  * @param eyes the vehicle's cameras
  * @param seed seed of the durations of recognition
  * @param seen called with each image; must not block
  */
private[skein] final class CameraSensor(
    val eye: Eye,
    eyes: Eyes,
    seed: Long,
    clock: Clock,
    note: (EventKind, String) => Unit,
    seen: Stamped[Image] => Unit = _ => ()
)(using system: ActorSystem):
  import CameraSensor.*
  import system.dispatcher

  private val threads: ExecutionContext = system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId)
  private val recognisers               = Vector.fill(eye.workers)(eye.recogniser())
  private val duration                  = LatencySampler(eye.takes, seed, SplitMix64.seedOf(seed, 3))
  private val began                     = clock.now()
  private val camera                    = AlignedCamera(eyes, eye.camera)
  private val newest                    = AtomicReference(Option.empty[Stamped[IArray[Double]]])
  private val stop                      = KillSwitches.shared(s"eye ${eye.vehicle}")

  // Used by one thread at a time: by the stream's thread, or by a reader's thread while the simulator stands
  // still.
  private var images, found = 0
  private var newestSeen    = Option.empty[Seen]
  private var fusion        = Fusion(eye.fusion)
  private val due, lost     = LongAdder()
  private val missed        = LongAdder()
  private val over          = Promise[Done]()

  @volatile private var runs = false

  /** Completes after it was closed, once every requested image has a result or has failed. */
  def ended: Future[Done] = over.future

  def counts: Counts = Counts(due.sum, missed.sum, lost.sum, images)

  /** Requests images periodically until it is closed. */
  def run(): Unit =
    runs = true
    val ticks = Source
      .fromGraph(Metronome(clock.now(), eye.every, clock))
      .via(stop.flow)
      .map: ticks =>
        due.add(ticks)
        ticks
    val (_, end) = Frames
      .at(ticks, inFlight = 2, camera.isNewer)(() => image())(skipped)
      .via(Recognise(
        eye.workers,
        eye.deadline,
        clock,
        newestFirst = true,
        camera.isNewer
      )(recognised)(unrecognised))
      .mapConcat(counted)
      .map: seen =>
        newestSeen = Some(seen)
        // Measurements from before a restart of the simulator do not hold after it.
        (camera.restarts, seen.measured)
      .via(Fuse(eye.fusion)((_, _) => say(EventKind.Dropped, "older than all that is known")))
      .toMat(Sink.foreach((_, belief) => newest.set(newestSeen.map(_.told(belief)))))(Keep.both)
      .run()
    over.completeWith(end)
    end.failed.foreach(error => say(EventKind.Aborted, s"$error"))

  /** Requests no more images. Completes as [[ended]] does, so that the last results are recorded. */
  def close(): Future[Done] =
    stop.shutdown()
    if runs then ended.recover { case _ => Done } else Future.successful(Done)

  /** The sensor that returns the present estimate. */
  val sensor: Sensor = new Sensor:
    def columns: Vector[String]                                       = Eye.Columns
    def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] =
      Future.successful(newest.get.toRight(VehicleError.Refused("nothing was seen yet")))

  /** The sensor for a simulator that stands still: takes an image and completes after recognition. */
  val looking: Sensor = new Sensor:
    def columns: Vector[String]                                       = Eye.Columns
    def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] =
      due.increment()
      image()
        .flatMap:
          case Left(error)  => Future.successful(skipped(Frames.Skipped.Failed(error)))
          case Right(frame) =>
            val startedAt = clock.now()
            recognised(0, frame).map: polar =>
              val took = clock.now().since(startedAt)
              for
                seen   <- counted(Recognised(frame.map(_ => polar), startedAt, took))
                joined <- fusion.including(seen.measured)
                belief <- joined.belief
              do
                fusion = joined
                newest.set(Some(seen.told(belief)))
        .recover: error =>
          loses(EventKind.Refused, s"$error")
        .flatMap(_ => sensor.read())

  private def image() = camera
    .image()
    .map(_.map: frame =>
      seen(frame)
      frame)

  private def recognised(worker: Int, frame: Stamped[Image]): Future[(Image, Option[PolarMeasurement])] =
    val startedAt = clock.now()
    val lasts     = duration.oneWay(startedAt.since(began)) * 2
    val image     = frame.value
    Future(look(worker, image))(using threads)
      .flatMap:
        case Left(reason) => Future.failed(IllegalArgumentException(reason))
        case Right(polar) =>
          // Work takes no virtual time, so this is the whole duration.
          val rest = lasts - clock.now().since(startedAt)
          if rest <= Span.Zero then Future.successful((image, polar))
          else after(rest.toDuration, system.scheduler)(Future.successful((image, polar)))

  private def look(worker: Int, image: Image): Either[String, Option[PolarMeasurement]] = image.pixels match
    case Pixels.Bgr(bytes) => recognisers(worker).find(image.width, image.height, bytes.buffer)
    case other             => Left(s"expected raw pixels, got ${other.productPrefix}")

  private def counted(recognised: Recognised[(Image, Option[PolarMeasurement])]): Option[Seen] =
    images += 1
    val (image, polar) = recognised.found.value
    polar.map: polar =>
      found += 1
      Seen(recognised.found.map(_ => image), polar, recognised.took, images, found)

  private def skipped(what: Frames.Skipped[Any, Any]): Unit = what match
    case Frames.Skipped.Missed(frames) =>
      missed.add(frames)
      say(EventKind.Skipped, s"$frames images not taken")
    case Frames.Skipped.Failed(error) => loses(EventKind.TimedOut, s"$error")
    case Frames.Skipped.Overtaken(_)  => loses(EventKind.Dropped, "an image overtaken")
    case Frames.Skipped.Repeated(_)   => loses(EventKind.Dropped, "the same image again")
    case Frames.Skipped.Replaced(_)   => loses(EventKind.Dropped, "an image replaced by a newer one")

  private def unrecognised(what: Unrecognised[Any]): Unit = what match
    case Unrecognised.Late(_)          => loses(EventKind.DeadlineMissed, "recognition was late")
    case Unrecognised.Failed(_, cause) => loses(EventKind.Refused, s"$cause")
    case Unrecognised.Overtaken(_)     => loses(EventKind.Dropped, "recognition overtaken")

  private def loses(kind: EventKind, why: String): Unit =
    lost.increment()
    say(kind, why)

  private def say(kind: EventKind, what: String): Unit = note(kind, s"${eye.sensor}: $what")

private[skein] object CameraSensor:

  /** Counts of an eye's images. After its end, each due image is in one of the other counts.
    *
    * @param missed number of due images that were not requested, since others were still in transit
    * @param lost number of images without a result: the call failed, recognition failed or was late, or a
    *   newer one was received first
    * @param searched number of images searched by recognition, with or without a detection
    */
  final case class Counts(due: Long, missed: Long, lost: Long, searched: Long):
    def asked: Long = due - missed

  private final case class Seen(
      image: Stamped[Image],
      polar: PolarMeasurement,
      took: Span,
      images: Int,
      found: Int
  ):
    def measured = polar.seenFrom(image.validAt, image.value.positionNed, image.value.orientation)

    /** The estimate as a sensor's reading, with [[Eye.Columns]]. */
    def told(belief: Belief): Stamped[IArray[Double]] =
      import image.value.{orientation as turned, positionNed as camera}
      image
        .copy(validAt = belief.at)
        .map: _ =>
          IArray(
            belief.positionNed.x,
            belief.positionNed.y,
            belief.positionNed.z,
            belief.velocityNed.x,
            belief.velocityNed.y,
            belief.velocityNed.z,
            math.sqrt(belief.position.xx.max(belief.position.yy).max(belief.position.zz)),
            polar.azimuth.value,
            polar.elevation.value,
            polar.range.value,
            took.toMillis,
            camera.x,
            camera.y,
            camera.z,
            turned.w,
            turned.x,
            turned.y,
            turned.z,
            images.toDouble,
            found.toDouble
          )
