package skein.environment

import scala.util.control.ControlThrowable
import skein.forward.{LoopObserver, Rollout}
import skein.lanes.{LearnerTeams, LearnerWorlds, TeamCandidate}
import skein.lanes.score.OfMoment
import skein.policy.{Action, LearnerSpace, SharesPolicy}
import skein.scenario.{Positions, Quantity, Reduction}
import skein.units.OwnFailure

/** One world by the scalar reference, [[Rollout]], whose learners' policies wait for the caller's decision:
  * so learning works in every scenario, loop and link of forward simulation.
  */
private final class LearnerRollout(side: LearnerSide, team: TeamCandidate, learners: Vector[Int])
    extends LearnerWorlds:
  import LearnerRollout.*

  private val flying          = Resumed(fly)
  private var ask: () => Unit = () => ()
  private val agents          = team.engagement.agents.toArray
  private var draw            = 0L
  private var isAnew          = false
  private var due             = Nobody
  private var untilS          = 0f
  private val space           = side.settings.space
  private val actions         = Array.ofDim[Float](learners.size, 2)
  private val observed        = Array.ofDim[Double](learners.size, space.inputs)
  private var (northM, eastM) = (Array.empty[Double], Array.empty[Double])
  private val downM           = Array.ofDim[Double](agents.length)
  private val values          = Array.ofDim[Double](team.quantities.size)
  private var lastScoredAtS   = 0.0
  private var hasEnded        = false

  def restartAlone: Boolean = false

  def start(draw: Long, untilS: Float): Unit =
    this.draw = draw
    this.untilS = untilS
    isAnew = true

  def restart(world: Int, vehicle: Int, northM: Float, eastM: Float, headingRad: Float): Unit =
    agents(vehicle) = agents(vehicle).copy(startX = northM, startY = eastM, startHeadingRad = headingRad)

  def flyOn(): Boolean =
    flying.goOn()
    flying.await()
    due != Nobody

  def isDue(learner: Int): Boolean = due == learner

  def observe(learner: Int, into: Array[Float]): Unit =
    for field <- 0 until space.inputs do
      into(field * LearnerWorlds.Most) = observed(learner)(field).toFloat

  def act(learner: Int, component: Int, numbers: Array[Float]): Unit =
    actions(learner)(component) = numbers(0)

  /** [[flyOn]] makes the decisions. */
  def decide(): Unit = ()

  def hasEnded(world: Int): Boolean = hasEnded

  def scoredAtS: Float = lastScoredAtS.toFloat

  def soFar(number: Int, into: Array[Float]): Unit = into(0) = values(number).toFloat

  def forgetScores(): Unit =
    for number <- values.indices do
      team.quantities(number).reduction match
        case OfMoment.Newest => ()
        case Reduction.Least => values(number) = Double.PositiveInfinity
        case _               => values(number) = 0

  def forgetScores(world: Int): Unit = forgetScores()

  override def close(): Unit = flying.close()

  private def fly(suspend: () => Unit): Unit =
    ask = suspend
    while true do
      isAnew = false
      hasEnded = false
      lastScoredAtS = 0
      java.util.Arrays.fill(values, Double.NaN)
      forgetScores()
      val flown = agents.toVector.zipWithIndex.map: (agent, vehicle) =>
        val learner = learners.indexOf(vehicle)
        if learner < 0 then agent else agent.copy(policy = Outside(learner))
      try
        northM = agents.map(_.startX)
        eastM = agents.map(_.startY)
        val rollout = Rollout(team.engagement.copy(agents = flown), side.timing, side.link, side.response)
        // More draws than keys, of which each needs a timetable.
        rollout.fly(LearnerTeams.keyOf(draw), observer = scores, sensorSeed = Some(draw))
        hasEnded = rollout.hasEnded
        due = Nobody
        suspend()
      catch case Anew => ()

  /** Its shares are rad/s or rad, and m/s: [[EnvironmentGroup]] has multiplied them already. */
  private final class Outside(learner: Int) extends SharesPolicy:
    private val byRate = side.mostTurn(learners(learner))._1

    def space: LearnerSpace     = side.settings.space
    def turnRateRadPerS: Double = if byRate then 1 else 0
    def turnRad: Double         = if byRate then 0 else 1
    def climbMps: Double        = 1

    def shares(seen: Array[Double]): Array[Double] =
      observed(learner) = seen
      due = learner
      ask()
      if isAnew then throw Anew
      actions(learner).map(_.toDouble)

  private object scores extends LoopObserver:
    override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
      northM(vehicle) = x; eastM(vehicle) = y; downM(vehicle) = z
      if vehicle == agents.length - 1 && timeS <= untilS + EnvironmentGroup.Tolerance then
        lastScoredAtS = timeS
        val places = Positions(IArray.from(northM), IArray.from(eastM), IArray.from(downM), timeS)
        for (judged, number) <- team.quantities.zipWithIndex do
          val value = Quantity.told(judged.quantity, places)
          judged.reduction match
            case OfMoment.Newest => values(number) = value
            case Reduction.Least => values(number) = values(number).min(value)
            case _               =>
              if !value.isFinite then
                throw OwnFailure(Quantity.whose(judged.quantity), s"answered $value, which is no reward")
              values(number) += (if judged.reduction == Reduction.Rms then value * value else value)

    override def commanded(vehicle: Int, number: Int, atNs: Long, action: Action): Unit =
      if !Action.isFinite(action) then
        throw OwnFailure(
          s"the policy of ${side.names(vehicle)}",
          s"decided for what no vehicle can do: $action"
        )

private object LearnerRollout:
  private val Nobody = -1

  private object Anew extends ControlThrowable
