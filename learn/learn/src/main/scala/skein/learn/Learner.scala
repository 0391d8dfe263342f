package skein.learn

/** Learns a policy from what comes of its actions. Learning has rounds: a learner draws from random numbers
  * of the round, and between two rounds it is what [[Saved.save]] keeps.
  */
trait Learner extends Saved:
  /** The policy: its first outputs, squashed by tanh, are the actions. */
  def actor: Network

  def begin(round: Long): Unit

  /** Actions that try something out, from −1 to 1.
    *
    * @param seen rows of what each environment shows
    */
  def explore(seen: Array[Float], actions: Array[Float]): Unit

  /** What came of the actions chosen last. */
  def learn(seen: Array[Float], actions: Array[Float], task: Task): Unit

  /** Learns what is left of the round. */
  def end(): Unit = ()

  /** Whether all numbers are. */
  def isFinite: Boolean
