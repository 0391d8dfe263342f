package skein.loop.learning

/** How a policy learns while it flies. */
enum Learning:
  /** Of the noise by which it tries out: a share of the most that it turns. */
  def explore: Double

  /** By a learner beside the flight.
    *
    * @param learner a new one, for a flight of this seed
    */
  case Beside(explore: Double, learner: Long => FlownLearner)

  /** As it did before.
    *
    * @param news what was new before which decision
    */
  case Again(explore: Double, news: Map[Long, Vector[LearnerUpdate]])
