package skein.flight

import java.nio.{ByteBuffer, ByteOrder}
import java.util.concurrent.ConcurrentHashMap
import scala.concurrent.ExecutionContext
import skein.airsim.{Image, Pixels, Scan, VehicleClient}
import skein.record.{Blob, Cloud, CameraImage, Recorder, ImagingSensor}
import skein.rpc.RpcError
import skein.signal.Stamped
import skein.units.*

/** Records images and scans of a vehicle's cameras and lidars. Thread-safe and non-blocking.
  *
  * @param isWanted whether images and scans are used by anyone
  */
private[skein] final class ImageRecorder(
    vehicle: VehicleClient,
    recorder: Recorder,
    isWanted: ImagingSensor => Boolean
):
  private val counts = ConcurrentHashMap[ImagingSensor, ImageRecorder.Count]()
  private val fovs   = ConcurrentHashMap[String, Radians]()
  private val missed = ConcurrentHashMap.newKeySet[String]()

  /** Requests the camera's field of view; without an answer, again at the camera's next image. */
  def ask(camera: String): Unit =
    vehicle.eyes.fov(camera).foreach {
      case Right(known) => fovs.put(camera, known): Unit
      case Left(_: (RpcError.Timeout | RpcError.Overloaded | RpcError.ConnectionLost)) =>
        missed.add(camera): Unit
      case Left(_) => ()
    }(using ExecutionContext.parasitic)

  /** Records an image, unless it repeats the previous one. */
  def image(frame: Stamped[Image]): Unit =
    val image = frame.value
    val shot  = image.shot
    if missed.remove(shot.camera) then ask(shot.camera)
    val sensor = ImagingSensor.camera(vehicle.name, shot.camera, shot.kind.toString)
    if isWanted(sensor) then
      val content = image.pixels match
        case Pixels.Bgr(bytes)      => Some(("bgr8", bytes.toArray))
        case Pixels.Numbers(values) => Some(("32FC1", ImageRecorder.bytes(values)))
        case Pixels.Png(_)          => None
      for
        (encoding, bytes) <- content
        number            <- next(sensor, frame.validAt)
      do
        recorder.offer(CameraImage(
          number,
          vehicle.name,
          shot.camera,
          shot.kind.toString,
          encoding,
          image.width,
          image.height,
          Option(fovs.get(shot.camera)),
          image.positionNed,
          image.orientation,
          frame.validAt,
          frame.sentAt,
          frame.receivedAt,
          Blob.of(bytes)
        ))

  /** Records a scan, unless it repeats the previous one. */
  def scan(lidar: String, frame: Stamped[Scan]): Unit =
    val sensor = ImagingSensor(vehicle.name, lidar, isLidar = true)
    if isWanted(sensor) then
      for number <- next(sensor, frame.validAt) do
        recorder.offer(Cloud(
          number,
          vehicle.name,
          lidar,
          frame.value.size,
          frame.value.positionNed,
          frame.value.orientation,
          frame.validAt,
          frame.sentAt,
          frame.receivedAt,
          Blob.of(ImageRecorder.bytes(frame.value.points))
        ))

  /** The number of a frame; absent if it repeats the previous one, as a sensor without new data does. */
  private def next(sensor: ImagingSensor, validAt: Instant): Option[Long] =
    val now = counts.compute(
      sensor,
      (_, before) =>
        if before == null then ImageRecorder.Count(1, validAt, isNew = true)
        else if before.validAt == validAt then before.copy(isNew = false)
        else ImageRecorder.Count(before.number + 1, validAt, isNew = true)
    )
    Option.when(now.isNew)(now.number)

private object ImageRecorder:
  private final case class Count(number: Long, validAt: Instant, isNew: Boolean)

  private def bytes(numbers: Array[Float]): Array[Byte] =
    val out = ByteBuffer.allocate(numbers.length * 4).order(ByteOrder.LITTLE_ENDIAN)
    out.asFloatBuffer.put(numbers)
    out.array
