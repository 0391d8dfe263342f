package skein.lanes.policy

import skein.forward.{Engagement, RolloutAgent}
import skein.fusion.SensorModel
import skein.policy.Policy
import skein.simd.{LaneMath, Recent}
import skein.units.Expect

/** SIMD decisions of two opponents that command headings: each decides by the difference of the two readings
  * ([[OpponentFormula]]), and yields a direction, not a velocity. This is faster than [[TeamLanes]].
  *
  * @param forms the policies' forms, indexed by vehicle
  * @param agents the vehicles: their speeds, first headings and cameras; if one has a camera, their starts
  *   too
  * @param withEffort whether a vehicle's effort is computed, indexed by vehicle
  */
private[lanes] final case class OpponentLanes private (
    forms: Vector[PolicyLanes],
    agents: Vector[RolloutAgent],
    withEffort: Vector[Boolean],
    inSpace: Boolean
) extends TeamPolicies:
  def count: Int         = 2
  def needsMore: Boolean = false
  def asksTime: Boolean  = false
  def sideBySide: Int    = LaneMath.LANES

  lazy val eyes: Map[Int, SensorModel] =
    agents.zipWithIndex.flatMap((agent, self) => agent.eye.map(self -> _)).toMap

  def cameras: Map[Int, CameraTrackerLanes.Forms] =
    eyes.view.mapValues(OpponentLanes.cameraOf(_).fold(sys.error, identity)).toMap

  def refusedByGpu: Option[String] = Option.when(eyes.nonEmpty)("the GPU flies nobody who sees by a sensor")

  def numbersOf(self: Int, policy: Policy): PolicyNumbers =
    PolicyNumbers(forms(self).parametersOf(policy), forms(self).initialOf(policy))

private[lanes] object OpponentLanes:
  private val cameras = Recent[SensorModel, Either[String, CameraTrackerLanes.Forms]](most = 64)

  private def cameraOf(sensor: SensorModel) = cameras.getOrMake(sensor)(CameraTrackerLanes.of(sensor))

  /** The SIMD code of two opponents; None unless they are two opponents that command headings.
    *
    * @param efforts whether a vehicle's effort is computed, indexed by vehicle
    * @param isPredicted whether readings are predicted
    * @return Left says why SIMD does not support a camera
    */
  def of(
      engagement: Engagement,
      efforts: Int => Boolean,
      inSpace: Boolean,
      isPredicted: Boolean
  ): Option[Either[String, OpponentLanes]] =
    val agents = engagement.agents
    for
      _     <- Option.when(engagement.assignment == OpponentFormula.Rivals)(())
      forms <-
        Expect.each(agents.indices)(self => PolicyLanes.of(agents(self).policy, self, isPredicted)).toOption
    yield Expect.each(agents.flatMap(_.eye))(cameraOf).map: _ =>
      val sees  = agents.exists(_.eye.isDefined)
      val alike = agents.map: agent =>
        if sees then agent.copy(policy = null)
        else agent.copy(startX = 0, startY = 0, altitudeDownM = 0, policy = null)
      OpponentLanes(forms, alike, Vector(efforts(0), efforts(1)), inSpace)
