package skein.airsim

import org.apache.pekko.Done
import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.wire.{Text, Vector3r}
import skein.rpc.{CallOptions, RpcClient, RpcError}
import skein.units.*
import upack.{Bool, Float64, Int32, Msg}
import upickle.default.{Reader, writeMsg}

/** Calls that concern a whole simulator: the built-in one, AirSim, Colosseum or Cosys-AirSim. Calls that
  * concern one vehicle are in [[Multirotor]].
  *
  * @param timeout time-out of calls that answer immediately; calls with a duration of their own add it to
  *   this
  */
final class AirSimClient(val rpc: RpcClient, val timeout: Span = Span.ofSeconds(5)):
  private given ExecutionContext = ExecutionContext.parasitic

  /** Whether the simulator has refused a camera function for its last argument; see [[Eyes]]. */
  @volatile private[airsim] var camerasTakeLess = false

  private val once      = CallOptions(timeout)
  private val whichever = once.copy(idempotent = true)

  def ping(): Future[Either[RpcError, Boolean]] = get("ping")

  /** The protocol version: 1 in AirSim, 4 in the built-in simulator and in Cosys-AirSim 3. */
  def serverVersion(): Future[Either[RpcError, Int]] = get("getServerVersion")

  /** The oldest client version that the simulator supports: 1. */
  def minRequiredClientVersion(): Future[Either[RpcError, Int]] = get("getMinRequiredClientVersion")

  def pause(): Future[Either[RpcError, Unit]] = tell("simPause", Seq(Bool(true)), whichever)

  def resume(): Future[Either[RpcError, Unit]] = tell("simPause", Seq(Bool(false)), whichever)

  def isPaused(): Future[Either[RpcError, Boolean]] = get("simIsPaused")

  /** Runs physics for `span` and pauses; answers when that is done. The built-in simulator advances by
    * exactly `span` and needs no wall-clock time for it; AirSim measures `span` with the wall clock and
    * overshoots by up to a step.
    */
  def continueFor(span: Span): Future[Either[RpcError, Unit]] =
    tell("simContinueForTime", Seq(Float64(span.toSeconds)), once.copy(timeout = timeout + span))

  /** Runs a number of frames and pauses. A frame is a picture in AirSim, 1/60 s in the built-in one. */
  def continueForFrames(frames: Int): Future[Either[RpcError, Unit]] =
    tell("simContinueForFrames", Seq(Int32(frames)), once)

  /** Returns every vehicle to its start: landed, disarmed, without API control. Moves end with false. */
  def reset(): Future[Either[RpcError, Unit]] = tell("reset", Seq(), once)

  /** The vehicles' names, in the order of the settings. */
  def vehicles(): Future[Either[RpcError, Seq[String]]] =
    get[Seq[Text]]("listVehicles").map(_.map(_.map(_.value)))

  def settingsText(): Future[Either[RpcError, String]] = get[Text]("getSettingsString").map(_.map(_.value))

  def settings(): Future[Either[AirSimError, WorldSettings]] =
    settingsText().map:
      case Left(error)                      => Left(AirSimError.Call(error))
      case Right(text) if text.trim.isEmpty => Right(WorldSettings.Default)
      case Right(text)                      => WorldSettings.parse(text).left.map(AirSimError.Settings(_))

  /** The errors of readings that the built-in simulator adds, as `--sensors` takes them. Without errors, and
    * in another simulator, it is empty.
    */
  def sensors(): Future[Either[RpcError, String]] = get[Text]("skeinSensors").map:
    case Left(_: RpcError.Refused) => Right("")
    case answer                    => answer.map(_.value)

  /** @param windNed velocity of the air, m/s
    */
  def setWind(windNed: Vector3): Future[Either[RpcError, Unit]] =
    tell("simSetWind", Seq(writeMsg(Vector3r(windNed))), whichever)

  /** Closes the connections; calls in progress end with [[RpcError.Cancelled]]. */
  def close(): Future[Done] = rpc.close()

  private def get[A: Reader](method: String): Future[Either[RpcError, A]] =
    rpc.callAs[A](method, Seq(), whichever)

  private def tell(method: String, params: Seq[Msg], options: CallOptions): Future[Either[RpcError, Unit]] =
    rpc.call(method, params, options).map(_.map(_ => ()))
