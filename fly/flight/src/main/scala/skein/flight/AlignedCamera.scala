package skein.flight

import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.{Eyes, Image, Shot}
import skein.rpc.RpcError
import skein.signal.{ClockAlignment, Stamped}

/** A camera, with the offset of the simulator's clock estimated from its images. Decides which of two images
  * is newer, also across a restart of the simulator. Thread-safe.
  */
private[flight] final class AlignedCamera(eyes: Eyes, camera: String):
  private val shot   = Shot(camera)
  private val clocks = AtomicReference(Option.empty[ClockAlignment])

  def image(): Future[Either[RpcError, Stamped[Image]]] = eyes
    .image(shot)
    .map(_.map: frame =>
      val _ = clocks.updateAndGet(known => Some(known.fold(ClockAlignment.of(frame))(_.updated(frame))))
      frame)(using ExecutionContext.parasitic)

  def isNewer(one: Stamped[?], other: Stamped[?]): Boolean =
    clocks.get.getOrElse(ClockAlignment.of(one)).isNewer(one, other)

  /** Number of times that the clock estimate restarted because the simulator's clock stopped or jumped, as
    * after a restart.
    */
  def restarts: Int = clocks.get.fold(0)(_.restarts)
