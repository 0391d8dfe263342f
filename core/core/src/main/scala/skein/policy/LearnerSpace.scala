package skein.policy

import skein.units.Vector3

/** What a learner observes and decides. Its actions are shares, −1 to 1, of its largest turn to the right
  * and, if it climbs, of its maximum vertical speed, positive up.
  */
final case class LearnerSpace(climbs: Boolean):
  /** Number of an observation's components; `outputs` is that of an action's. */
  def inputs: Int  = if climbs then LearnerSpace.ClimbInputs else LearnerSpace.LevelInputs
  def outputs: Int = if climbs then 2 else 1

  /** Divisors of a network's inputs, which scale all inputs to about −1 to 1. */
  def scales: Vector[Double] =
    val level = Vector[Double](20, 20, 10, 10, 1, 1, 0.2, 0.2, 0.2)
    if climbs then level ++ Vector[Double](20, 10, 50, 10) else level

  /** The network's inputs: [[PlanarObservation.fromOwnHeading]]. Climbing learners also get, positive up, the
    * opponent's height (m) and vertical speed (m/s) relative to this vehicle, and this vehicle's altitude
    * above z = 0 (m) and vertical speed (m/s).
    */
  def observe(seen: Observation): Array[Double] =
    val level = PlanarObservation.of(seen).fromOwnHeading
    if !climbs then level
    else
      val (own, opponent) = (seen.own.kinematics, seen.vehicles(seen.opponent).kinematics)
      val all             = java.util.Arrays.copyOf(level, LearnerSpace.ClimbInputs)
      all(LearnerSpace.LevelInputs) = own.positionNed.z - opponent.positionNed.z
      all(LearnerSpace.LevelInputs + 1) = own.velocityNed.z - opponent.velocityNed.z
      all(LearnerSpace.LevelInputs + 2) = -own.positionNed.z
      all(LearnerSpace.LevelInputs + 3) = -own.velocityNed.z
      all

  /** Flight at the vehicle's own horizontal speed after a turn to the right: at the altitude of its start,
    * or, if it climbs, with a vertical speed, positive up.
    */
  def action(seen: Observation, turnRad: Double, upMps: Double): Action =
    val headingRad = seen.headingRad + turnRad
    if !climbs then seen.along(headingRad, seen.cruise.value)
    else
      val speed = seen.cruise.value
      Action.Velocity(
        Vector3(speed * StrictMath.cos(headingRad), speed * StrictMath.sin(headingRad), -upMps)
      )

/** A policy that observes and decides as learners do, without a memory. */
trait SharesPolicy extends Policy.Memoryless:

  def space: LearnerSpace

  /** The largest turn per second since the previous decision, rad/s; the largest turn of one decision,
    * whatever that time, rad; and the maximum vertical speed, m/s. A decision turns the heading immediately.
    */
  def turnRateRadPerS: Double
  def turnRad: Double
  def climbMps: Double

  /** The components of the action for an observation, each from −1 to 1. */
  def shares(observed: Array[Double]): Array[Double]

  final override def isAgainstOne: Boolean = true

  final override def isPlanar: Boolean = !space.climbs

  final def act(seen: Observation, shares: Array[Double]): Action =
    val turn = shares(0) * (turnRateRadPerS * seen.elapsed.toSeconds + turnRad)
    space.action(seen, turn, if space.climbs then shares(1) * climbMps else 0)

  final def action(seen: Observation): Action = act(seen, shares(space.observe(seen)))

object LearnerSpace:
  private final val LevelInputs = 9
  private final val ClimbInputs = 13

  val Level: LearnerSpace    = LearnerSpace(climbs = false)
  val Climbing: LearnerSpace = LearnerSpace(climbs = true)

  /** The space of a network's observations and actions. */
  def of(shape: NeuralShape): LearnerSpace = LearnerSpace(shape.outputs == Climbing.outputs)

  /** Default maximum vertical speed of climbing policies, m/s. */
  val ClimbMps = 3.0
