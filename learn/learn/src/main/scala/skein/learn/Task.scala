package skein.learn

/** What is learned: several environments side by side, stepped together. Numbers stand row by row, a row an
  * environment.
  */
trait Task:
  /** Environments. */
  def count: Int

  /** Numbers that an environment shows, each of about −1 to 1. */
  def observations: Int

  /** Numbers that it takes, from −1 to 1. */
  def actions: Int

  /** All episodes begin anew; equal rounds begin equally.
    *
    * @param actor the policy so far, for those who share it
    */
  def begin(round: Long, actor: Network): Unit

  /** What is seen now. */
  def seen: Array[Float]

  /** One step of every environment; where an episode ends, the next one begins. */
  def step(actions: Array[Float]): Unit

  /** Of the last step. */
  def rewards: Array[Float]

  /** What was seen after the last step, also where an episode ended by it. */
  def reached: Array[Float]

  /** Whether the last step ended an episode for good: nothing would have come after. */
  def terminated: Array[Boolean]

  /** Whether the last step ended an episode at all. */
  def ended: Array[Boolean]
