package skein.policy

/** A trained policy that climbs and sinks: a [[LearnedPolicy]] in [[LearnerSpace.Climbing]], whose network's
  * second output is the share of its greatest vertical speed.
  *
  * @param climbMps greatest vertical speed
  */
final case class ClimbingPolicy(
    shape: NeuralShape,
    parameters: Vector[Double],
    turnRateRadPerS: Double,
    turnRad: Double,
    climbMps: Double
) extends Policy:
  private val network = LearnedNetwork(shape, parameters, LearnerSpace.Climbing)

  type Memory = Unit

  def start: Unit = ()

  override def isAgainstOne: Boolean = true

  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    val shares = network.shares(LearnerSpace.Climbing.observe(seen))
    val turn   = shares(0) * (turnRateRadPerS * seen.elapsed.toSeconds + turnRad)
    (LearnerSpace.Climbing.action(seen, turn, shares(1) * climbMps), ())
