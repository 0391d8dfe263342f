package skein.lanes

import skein.forward.Duel
import skein.fusion.SensorModel
import skein.lanes.policy.CameraTrackerLanes

/** The cameras that are an agent's only knowledge of its opponent in a duel, if it has one. */
private[lanes] final case class DuelEyes(
    evader: Option[CameraTrackerLanes.Forms],
    pursuer: Option[CameraTrackerLanes.Forms]
):
  def isNobody: Boolean = evader.isEmpty && pursuer.isEmpty

private[lanes] object DuelEyes:
  val Nobody: DuelEyes = DuelEyes(None, None)

  /** The compiled cameras; Left states why SIMD does not support them. */
  def of(duel: Duel): Either[String, DuelEyes] =
    def forms(eye: Option[SensorModel]) =
      eye.fold[Either[
        String,
        Option[CameraTrackerLanes.Forms]
      ]](Right(None))(CameraTrackerLanes.of(_).map(Some(_)))
    for
      evader  <- forms(duel.evader.eye)
      pursuer <- forms(duel.pursuer.eye)
    yield DuelEyes(evader, pursuer)
