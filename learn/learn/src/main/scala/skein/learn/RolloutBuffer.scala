package skein.learn

/** The newest steps of all environments in order, and the advantage of each.
  *
  * @param steps number of steps of each environment that it contains
  */
private[learn] final class RolloutBuffer(observations: Int, acted: Int, count: Int, val steps: Int):
  val seen: Array[Float]       = Array.ofDim(steps * count * observations)
  val actions: Array[Float]    = Array.ofDim(steps * count * acted)
  val logs: Array[Float]       = Array.ofDim(steps * count)
  val values: Array[Float]     = Array.ofDim(steps * count)
  val advantages: Array[Float] = Array.ofDim(steps * count)

  /** Target values of the states, by step and environment. */
  val returns: Array[Float] = Array.ofDim(steps * count)
  private val rewards       = Array.ofDim[Float](steps * count)

  /** The value of each step's reached state; 0 where the episode terminated. */
  private val ahead   = Array.ofDim[Float](steps * count)
  private val chained = Array.ofDim[Boolean](steps * count)
  private var filled  = 0

  def isFull: Boolean = filled == steps
  def rows: Int       = filled * count
  def clear(): Unit   = filled = 0

  /** @param reachedValues values of the states that the step reached */
  def add(
      seenNow: Array[Float],
      chosen: Array[Float],
      logsNow: Array[Float],
      valuesNow: Array[Float],
      reachedValues: Array[Float],
      task: Task
  ): Unit =
    val from = filled * count
    System.arraycopy(seenNow, 0, seen, from * observations, count * observations)
    System.arraycopy(chosen, 0, actions, from * acted, count * acted)
    System.arraycopy(logsNow, 0, logs, from, count)
    System.arraycopy(valuesNow, 0, values, from, count)
    System.arraycopy(task.rewards, 0, rewards, from, count)
    for row <- 0 until count do
      ahead(from + row) = if task.terminated(row) then 0 else reachedValues(row)
      chained(from + row) = !task.ended(row)
    filled += 1

  /** Generalised advantage estimation: Schulman, Moritz, Levine, Jordan, Abbeel, arXiv:1506.02438, equation
    * 16.
    */
  def estimate(discount: Double, decay: Double): Unit =
    for row <- 0 until count do
      var advantage = 0.0
      for step <- filled - 1 to 0 by -1 do
        val at    = step * count + row
        val error = rewards(at) + discount * ahead(at) - values(at)
        advantage = error + (if chained(at) then discount * decay * advantage else 0)
        advantages(at) = advantage.toFloat
        returns(at) = (advantage + values(at)).toFloat
