package skein.rollout

/** The timing of a control loop as data: when an observation is taken, how old it is at the decision, when the command
  * takes effect, what replaces what. [[Rollout]] derives its events from it; the kernels, the same events by lanes.
  *
  * A question, its answer and a command take a one-way delay each, sampled independently; each vehicle's questions,
  * answers, commands and acknowledgements keep their order. A command is acknowledged when a newer one has replaced it.
  */
enum LoopTiming:
  /** Between decisions for one vehicle, s. */
  def periodS: Double

  /** The world stands still while all vehicles are read, decided for and commanded; then it runs one period. */
  case Paused(periodS: Double = 0.1)

  /** Reads the vehicles one after the other, decides for all, commands all, and waits one period after the last
    * answer.
    */
  case Sequential(periodS: Double = 0.1)

  /** Every period one task per vehicle: it reads all vehicles one after the other, decides for its own and commands it.
    * Tasks may overlap.
    */
  case Futures(periodS: Double = 0.1)

  /** Asks all vehicles every period; when all have answered anew, the picture is complete. Each vehicle decides on the
    * newest picture as soon as its pace and its commands in flight allow; a picture that a newer one replaces before
    * is skipped.
    *
    * @param toleranceS
    *   how much before its turn a decision may come; turns come once a period
    */
  case Stream(periodS: Double = 0.1, toleranceS: Double = 0.05)

object LoopTiming:
  /** Commands to one vehicle that may be unacknowledged: the one that flies and the one that replaces it. */
  val MostOutstanding = 2
