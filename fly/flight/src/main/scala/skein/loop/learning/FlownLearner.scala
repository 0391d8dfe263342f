package skein.loop.learning

/** What a policy saw, did, and came to by it. What is seen is
  * [[skein.policy.PlanarObservation.fromOwnHeading]].
  *
  * @param share of the most that it turns, −1 to 1
  * @param reached what was seen at the next decision
  * @param distanceM to the opponent then
  */
final case class Transition(
    seen: Vector[Double],
    share: Double,
    reached: Vector[Double],
    distanceM: Double
)

/** Learns from a flight, beside it. One thread at a time. What it throws ends the learning, not the flight.
  */
trait FlownLearner:

  /** A lesson, or a part of a long one.
    *
    * @param transitions in the order in which they were flown
    * @return parameters of the policy from now on, if it is to be another, in the order of its family's axes
    */
  def learn(transitions: Vector[Transition]): Option[Vector[Double]]
