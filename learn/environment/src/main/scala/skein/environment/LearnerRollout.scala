package skein.environment

import scala.util.control.ControlThrowable
import skein.forward.{LoopObserver, Rollout}
import skein.policy.{Action, PlanarObservation, HeadingPolicy, Policy}
import skein.signal.SplitMix64
import skein.simd.WorldRandom
import skein.units.OwnFailure

/** Episodes of a scenario, one after the other, that stop whenever the vehicle of a learner is to decide.
  * They are simulated by [[Rollout]], whose policy waits for the caller's decision: so learning works in
  * every scenario, loop and link of forward simulation. Mutable.
  *
  * @param learner the vehicle, by its index in the scenario
  */
private final class LearnerRollout(side: ScenarioSide, learner: Int) extends AutoCloseable:
  import LearnerRollout.*

  private val flying                 = Resumed(fly)
  private var next                   = Option.empty[(Long, Option[Policy])]
  private var ask: () => Unit        = () => ()
  private var isBegun                = false
  private val (rateRadPerS, turnRad) = side.settings.mostTurn(side.role)

  /** The vehicle's current observation, in the form of [[PlanarObservation.fromOwnHeading]]. */
  val seen: Array[Float] = Array.ofDim(skein.lanes.LearnerDuels.FIELDS)

  /** The turn to make now, as a fraction, −1 to 1. */
  var share: Double = 0

  /** The cost since the last decision, in the reward's unit. */
  var loss: Double = 0

  /** Distance to the nearest opponent, m: at the last score, and the least since the last decision. */
  var distanceM, leastM: Double = 0

  /** Time of the last score, since the episode's beginning, s. */
  var scoredAtS: Double = 0
  var isOver: Boolean   = true

  /** Makes the next [[goOn]] start an episode, abandoning the current one.
    *
    * @param beside the policy of the others of its role; without one, their own
    */
  def begin(seed: Long, beside: Option[Policy]): Unit = next = Some((seed, beside))

  /** Continues the simulation. Nothing may be read until [[await]] has returned. */
  def goOn(): Unit = flying.goOn()

  /** Blocks until the vehicle is to decide, or the episode has ended. */
  def await(): Unit = flying.await()

  def close(): Unit = flying.close()

  private def fly(suspend: () => Unit): Unit =
    ask = suspend
    while true do
      val (seed, beside) = next.get
      next = None
      isOver = false
      scoredAtS = 0
      try
        val engagement = side.engagement(learner, outside, beside, seed)
        begun(engagement.agents.map(_.startX).toArray, engagement.agents.map(_.startY).toArray)
        Rollout(engagement, side.timing, side.link, side.response)
          .fly(
            WorldRandom.key(1, 0, ((SplitMix64.seedOf(seed, 1) >>> 1) % Flights).toInt),
            observer = scores
          ): Unit
        // No decision was due after the end.
        isOver = true
        suspend()
      catch case Anew => ()

  private def begun(northM: Array[Double], eastM: Array[Double]): Unit =
    distanceM = side.distanceM(learner, northM, eastM)
    leastM = Double.PositiveInfinity
    loss = 0
    isBegun = false

  private object outside extends HeadingPolicy.Memoryless:
    def heading(now: PlanarObservation): Double =
      for (number, field) <- now.fromOwnHeading.iterator.zipWithIndex do seen(field) = number.toFloat
      isOver = scoredAtS + EnvironmentGroup.Tolerance >= side.settings.episodeS
      ask()
      if next.isDefined then throw Anew
      // Scores before the first decision count for the first step.
      if isBegun then
        loss = 0
        leastM = Double.PositiveInfinity
      isBegun = true
      now.ownHeadingRad + share * (rateRadPerS * now.elapsedS + turnRad)

  private object scores extends LoopObserver:
    private val northM, eastM = Array.ofDim[Double](side.count)

    override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
      northM(vehicle) = x
      eastM(vehicle) = y
      if vehicle == side.count - 1 && timeS <= side.settings.episodeS + EnvironmentGroup.Tolerance then
        scoredAtS = timeS
        distanceM = side.distanceM(learner, northM, eastM)
        leastM = leastM.min(distanceM)
        loss += side.loss(distanceM, northM, eastM)

    override def commanded(vehicle: Int, number: Int, atNs: Long, action: Action): Unit =
      if !Action.isFinite(action) then
        throw OwnFailure(
          s"the policy of ${side.nameOf(vehicle)}",
          s"decided for what no vehicle can do: $action"
        )

private object LearnerRollout:
  private object Anew extends ControlThrowable

  /** Number of flights over the link, one of which each episode draws. */
  private val Flights = 1 << 24
