package skein.airsim

import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.wire.ImageRequest
import skein.rpc.{TimedReply, CallOptions, Channel, MessageReader, RpcError, WhenFull}
import skein.signal.Stamped
import skein.units.*
import upack.{Bool, Msg, Str}
import upickle.default.writeMsg

/** Cameras and lidars of one vehicle. Images and scans use connections of their own ([[Channel.Bulk]]), so
  * they never delay control; each is stamped with its exposure time. A request is refused while
  * [[skein.rpc.RpcSettings.windowInAll]] requests are unanswered; `skein.flow.Frames` requests at a given
  * rate, keeps the newest and counts what it skips.
  *
  * @param originNed origin of the vehicle's own frame in the world, m
  */
final class Eyes private[airsim] (client: AirSimClient, vehicle: String, originNed: Vector3):
  private given ExecutionContext = ExecutionContext.parasitic

  private val options =
    CallOptions(client.timeout, Channel.Bulk, idempotent = true, whenFull = WhenFull.Refuse)

  /** Takes several images of one instant, in the order of the shots. */
  def images(shots: Seq[Shot]): Future[Either[RpcError, Stamped[Vector[Image]]]] =
    val asked = shots.map: shot =>
      ImageRequest(
        shot.camera,
        shot.kind.number,
        pixels_as_float = shot.encoding == Encoding.Numbers,
        compress = shot.encoding == Encoding.Png
      )
    askCamera("simGetImages", Seq(writeMsg(asked), Str(vehicle)))(Images.read(_, shots, originNed))

  def image(shot: Shot): Future[Either[RpcError, Stamped[Image]]] =
    images(Seq(shot)).map(_.map(_.map(_.head)))

  /** The newest scan of a lidar; an empty name means the first lidar. Between two scans it returns the older
    * one again.
    */
  def scan(lidar: String = ""): Future[Either[RpcError, Stamped[Scan]]] =
    ask("getLidarData", Seq(Str(lidar), Str(vehicle)))(Images.readScan(_, originNed))

  def fov(camera: String): Future[Either[RpcError, Radians]] =
    askCamera("simGetCameraInfo", Seq(Str(camera), Str(vehicle)))(in =>
      Right((Images.readFov(in), Instant.Epoch))
    )
      .map(_.map(_.value))

  /** Camera functions end with the argument `external` in AirSim and Colosseum, and lack it in Cosys-AirSim
    *   3. The client learns which from the simulator's first refusal, and remembers it.
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
  /** rpclib's error text for a wrong number of arguments. */
  val WrongCount = "invalid number of arguments"
