package skein.loop.learning

/** How a policy learns during a flight: anew, or by recorded versions. */
enum Learning:
  /** Standard deviation of the exploration noise, as a fraction of the largest turn. */
  def explore: Double

  /** Learns by a learner that runs concurrently with the flight.
    *
    * @param learner makes one for a flight of this seed
    */
  case Beside(explore: Double, learner: Long => FlownLearner)

  /** Repeats recorded learning.
    *
    * @param news the updates, keyed by the sequence number of the decision before which they took effect
    */
  case Again(explore: Double, news: Map[Long, Vector[LearnerUpdate]])
