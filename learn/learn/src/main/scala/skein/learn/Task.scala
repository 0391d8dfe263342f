package skein.learn

/** A learning task: several environments that are stepped together. Arrays are row by row, a row for each
  * environment.
  */
trait Task:
  def count: Int

  /** Number of observations of an environment, each of about −1 to 1. */
  def observations: Int

  /** Number of actions of an environment, each from −1 to 1. */
  def actions: Int

  /** Starts all episodes; equal rounds start equally.
    *
    * @param actor the policy so far, for tasks in which others use it
    */
  def begin(round: Long, actor: Network): Unit

  def seen: Array[Float]

  /** Advances every environment by one step; where an episode ends, the next one begins. */
  def step(actions: Array[Float]): Unit

  def rewards: Array[Float]

  /** The observations after the last step, also where it ended an episode. */
  def reached: Array[Float]

  /** Whether the last step terminated an episode: no return could follow. */
  def terminated: Array[Boolean]

  /** Whether the last step ended an episode, by termination or truncation. */
  def ended: Array[Boolean]
