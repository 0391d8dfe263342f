package skein.airsim

import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.wire.ImageRequest
import skein.rpc.{TimedReply, CallOptions, Channel, MessageReader, RpcError, WhenFull}
import skein.signal.Stamped
import skein.units.*
import upack.{Bool, Msg, Str}
import upickle.default.writeMsg

/** Cameras and lidars of one vehicle. Images and scans come on connections of their own ([[Channel.Bulk]]),
  * so nothing that flies the vehicle waits for them, and are stamped with their exposure. A question is
  * refused while [[skein.rpc.RpcSettings.windowInAll]] of them are unanswered; `skein.flow.Frames` asks as
  * often as wanted, keeps the newest and counts what it skips.
  *
  * @param originNed where the vehicle's own frame has its origin
  */
final class Eyes private[airsim] (client: AirSimClient, vehicle: String, originNed: Vector3):
  private given ExecutionContext = ExecutionContext.parasitic

  private val options =
    CallOptions(client.timeout, Channel.Bulk, idempotent = true, whenFull = WhenFull.Refuse)

  /** Several images of one moment, in the order of the shots. */
  def images(shots: Seq[Shot]): Future[Either[RpcError, Stamped[Vector[Image]]]] =
    val asked = shots.map: shot =>
      ImageRequest(
        shot.camera,
        shot.kind.number,
        pixels_as_float = shot.encoding == Encoding.Numbers,
        compress = shot.encoding == Encoding.Png
      )
    askCamera("simGetImages", Seq(writeMsg(asked), Str(vehicle)))(Images.read(_, shots, originNed))

  /** One image. */
  def image(shot: Shot): Future[Either[RpcError, Stamped[Image]]] =
    images(Seq(shot)).map(_.map(_.map(_.head)))

  /** The newest scan of a lidar; an empty name means the first. Between two scans the older one comes again.
    */
  def scan(lidar: String = ""): Future[Either[RpcError, Stamped[Scan]]] =
    ask("getLidarData", Seq(Str(lidar), Str(vehicle)))(Images.readScan(_, originNed))

  /** A camera's horizontal field of view. */
  def fov(camera: String): Future[Either[RpcError, Radians]] =
    askCamera("simGetCameraInfo", Seq(Str(camera), Str(vehicle)))(in =>
      Right((Images.readFov(in), Instant.Epoch))
    )
      .map(_.map(_.value))

  /** Functions of cameras end with `external` in AirSim and Colosseum, and have no such argument in
    * Cosys-AirSim 3. Which it is the simulator tells by its first refusal, and the client remembers.
    */
  private def askCamera[A](method: String, params: Seq[Msg])(
      read: MessageReader => Either[String, (A, Instant)]
  ): Future[Either[RpcError, Stamped[A]]] =
    if client.camerasTakeLess then ask(method, params)(read)
    else
      ask(method, params :+ Bool(false))(read).flatMap:
        case Left(RpcError.Refused(_, text)) if text.contains(Eyes.WrongCount) =>
          client.camerasTakeLess = true
          ask(method, params)(read)
        case other => Future.successful(other)

  private def ask[A](method: String, params: Seq[Msg])(
      read: MessageReader => Either[String, (A, Instant)]
  ): Future[Either[RpcError, Stamped[A]]] =
    client.rpc.callBulk(method, params, options)(read).map(_.flatMap:
      case TimedReply(Right((value, validAt)), sentAt, receivedAt) =>
        Right(Stamped(value, validAt, sentAt, receivedAt))
      case TimedReply(Left(reason), _, _) => Left(RpcError.Malformed(method, reason)))

private object Eyes:
  /** rpclib's words for another number of arguments than the function has. */
  val WrongCount = "invalid number of arguments"
