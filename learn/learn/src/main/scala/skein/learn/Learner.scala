package skein.learn

/** Learns a policy from the results of its actions, in rounds. A round's number seeds the learner's random
  * numbers, and between two rounds [[Saved.save]] writes its complete state.
  */
trait Learner extends Saved:
  /** The policy: its first outputs, squashed by tanh, are the actions. */
  def actor: Network

  def begin(round: Long): Unit

  /** Chooses actions with exploration, from −1 to 1.
    *
    * @param seen a row of observations for each environment
    */
  def explore(seen: Array[Float], actions: Array[Float]): Unit

  /** Takes the results of the actions chosen last. */
  def learn(seen: Array[Float], actions: Array[Float], task: Task): Unit

  /** Learns from the rest of the round's steps. */
  def end(): Unit = ()

  def isFinite: Boolean
