package skein.lanes.policy

import java.util.concurrent.ConcurrentHashMap
import skein.forward.{Engagement, RolloutAgent}
import skein.fusion.SensorModel
import skein.policy.{HeadingPolicy, Policy}
import skein.simd.LaneMath
import skein.units.Expect

/** SIMD decisions of two that play against one another by [[HeadingPolicy]]: each by the difference of the
  * two readings, compiled from [[HeadingPolicy.decide]] alone, and of directions, not velocities. So they fly
  * faster than by [[TeamLanes]].
  *
  * @param forms by vehicle
  * @param agents by vehicle: their speeds, first headings and cameras; where somebody sees by a camera, their
  *   starts too
  * @param withEffort by vehicle, whether its effort is computed
  */
private[lanes] final case class OpponentLanes private (
    forms: Vector[PolicyLanes],
    agents: Vector[RolloutAgent],
    withEffort: Vector[Boolean],
    inSpace: Boolean
) extends TeamPolicies:
  def count: Int         = 2
  def needsMore: Boolean = false
  def sideBySide: Int    = LaneMath.LANES

  lazy val eyes: Map[Int, SensorModel] =
    agents.zipWithIndex.flatMap((agent, self) => agent.eye.map(self -> _)).toMap

  def cameras: Map[Int, CameraTrackerLanes.Forms] =
    eyes.view.mapValues(OpponentLanes.cameraOf(_).fold(sys.error, identity)).toMap

  def refusedByGpu: Option[String] = Option.when(eyes.nonEmpty)("the GPU flies nobody who sees by a sensor")

  def numbersOf(self: Int, policy: Policy): PolicyNumbers =
    val own = policy.asInstanceOf[HeadingPolicy]
    PolicyNumbers(forms(self).parametersOf(own), forms(self).initialOf(own))

private[lanes] object OpponentLanes:
  private val cameras = ConcurrentHashMap[SensorModel, Either[String, CameraTrackerLanes.Forms]]()

  private def cameraOf(sensor: SensorModel) = cameras.computeIfAbsent(sensor, CameraTrackerLanes.of)

  /** The SIMD code of two opponents, or why there is none; None where they are not two that play against one
    * another by headings.
    *
    * @param efforts of which vehicles are computed
    */
  def of(
      engagement: Engagement,
      efforts: Int => Boolean,
      inSpace: Boolean
  ): Option[Either[String, OpponentLanes]] =
    val agents = engagement.agents
    Option.when(areOpponents(engagement)):
      for
        _     <- Expect.each(agents.flatMap(_.eye))(cameraOf)
        forms <- Expect.each(agents)(agent => PolicyLanes.of(agent.policy.asInstanceOf[HeadingPolicy]))
          .left.map(refused => s"a policy is no formula: ${refused.getMessage}")
      yield
        val sees  = agents.exists(_.eye.isDefined)
        val alike = agents.map: agent =>
          if sees then agent.copy(policy = null)
          else agent.copy(startX = 0, startY = 0, altitudeDownM = 0, policy = null)
        OpponentLanes(forms, alike, Vector(efforts(0), efforts(1)), inSpace)

  private def areOpponents(engagement: Engagement) =
    engagement.agents.size == 2 && engagement.assignment.rivals == Rivals &&
      engagement.agents.forall(_.policy.isInstanceOf[HeadingPolicy])

  private val Rivals = Vector(Vector(1), Vector(0))
