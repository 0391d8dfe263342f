package skein.learn

/** Learning, round by round: in each, every environment is reset and makes a fixed number of steps. Between
  * two rounds it can be saved and continued with identical bits.
  *
  * @param stepsPerRound number of steps of each environment in a round
  */
final class Training(task: Task, learner: Learner, stepsPerRound: Int):
  private val actions = Array.ofDim[Float](task.count * task.actions)
  private val seen    = Array.ofDim[Float](task.count * task.observations)

  def stepsOfRound: Long = stepsPerRound.toLong * task.count

  /** @param isStopped checked at every step; the rest of the round is not learned then
    * @return the mean reward of a step; Left says what is wrong; None if it was stopped
    */
  def round(number: Long, isStopped: () => Boolean = () => false): Either[String, Option[Double]] =
    learner.begin(number)
    task.begin(number, learner.actor)
    var sum   = 0.0
    var step  = 0
    var wrong = notShown(number)
    while wrong.isEmpty && step < stepsPerRound && !isStopped() do
      System.arraycopy(task.seen, 0, seen, 0, seen.length)
      learner.explore(seen, actions)
      if !areFinite(actions) then wrong = Some(diverged(number))
      else
        task.step(actions)
        wrong = notRewarded(number).orElse(notShown(number))
        if wrong.isEmpty then
          for reward <- task.rewards do sum += reward
          learner.learn(seen, actions, task)
          step += 1
    wrong match
      case Some(reason)                 => Left(reason)
      case None if step < stepsPerRound => Right(None)
      case None                         =>
        learner.end()
        Either.cond(learner.isFinite, Some(sum / stepsOfRound), diverged(number))

  private def diverged(round: Long) =
    s"round ${round + 1}: the weights are not finite any more; a smaller learning rate may help"

  /** Reports a task's reward that is not finite, which would corrupt all weights. */
  private def notRewarded(round: Long) = Option.unless(areFinite(task.rewards)):
    val environment = task.rewards.indexWhere(!_.isFinite)
    s"round ${round + 1}: expected a finite reward, got ${task.rewards(environment)} in environment $environment"

  private def notShown(round: Long) =
    Seq(task.seen, task.reached).find(!areFinite(_)).map: shown =>
      val at                   = shown.indexWhere(!_.isFinite)
      val (environment, field) = (at / task.observations, at % task.observations)
      s"round ${round + 1}: expected finite observations, got ${shown(at)} as number $field in environment $environment"

  private def areFinite(numbers: Array[Float]): Boolean =
    var at = 0
    while at < numbers.length && numbers(at).isFinite do at += 1
    at == numbers.length
