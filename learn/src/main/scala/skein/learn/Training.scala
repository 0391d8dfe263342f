package skein.learn

/** Learning, round by round: in each, every environment begins anew and is stepped a fixed number of times.
  * Between two rounds it can be saved and gone on with, to the same bits.
  *
  * @param stepsPerRound of each environment
  */
final class Training(task: Task, learner: Learner, stepsPerRound: Int):
  private val actions = Array.ofDim[Float](task.count * task.actions)
  private val seen    = Array.ofDim[Float](task.count * task.observations)

  def stepsOfRound: Long = stepsPerRound.toLong * task.count

  /** @param isStopped asked at every step; what is left of the round is not learned then
    * @return the mean reward of a step; or what is wrong; or nothing if it was stopped
    */
  def round(number: Long, isStopped: () => Boolean = () => false): Either[String, Option[Double]] =
    learner.begin(number)
    task.begin(number, learner.actor)
    var sum  = 0.0
    var step = 0
    while step < stepsPerRound && !isStopped() do
      System.arraycopy(task.seen, 0, seen, 0, seen.length)
      learner.explore(seen, actions)
      task.step(actions)
      for reward <- task.rewards do sum += reward
      learner.learn(seen, actions, task)
      step += 1
    if step < stepsPerRound then Right(None)
    else
      learner.end()
      Either.cond(
        learner.isFinite,
        Some(sum / stepsOfRound),
        s"round ${number + 1}: the weights are not finite any more; a smaller learning rate may help"
      )
