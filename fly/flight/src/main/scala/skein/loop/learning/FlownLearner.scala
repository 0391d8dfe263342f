package skein.loop.learning

/** One step of a policy, for learning: observation, action and result. Observations and actions are those of
  * the policy's [[skein.policy.LearnerSpace]].
  *
  * @param shares the chosen action
  * @param reached the observation at the next decision
  * @param distanceM distance to the opponent at the next decision, in space if the policy climbs, m
  */
final case class Transition(
    seen: Vector[Double],
    shares: Vector[Double],
    reached: Vector[Double],
    distanceM: Double
)

/** Learns from a flight, concurrently with it. One thread at a time. An exception ends the learning, not the
  * flight.
  */
trait FlownLearner:

  /** Learns one lesson, or a part of a long one.
    *
    * @param transitions the flight's transitions, in order
    * @return new parameters of the policy, if they change, in the order of its family's axes
    */
  def learn(transitions: Vector[Transition]): Option[Vector[Double]]
