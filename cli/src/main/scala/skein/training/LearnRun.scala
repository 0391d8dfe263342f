package skein.training

import java.nio.file.Path
import skein.lanes.DuelBatch
import skein.learn.{DuelTask, Learner, Training, Workers}
import skein.optimise.Direction

/** Learns round by round, judges the policy now and then, and keeps its state on disk.
  *
  * @param folder
  *   without one, nothing is kept
  */
final class LearnRun(setup: LearnSetup, batch: DuelBatch, folder: Option[Path], nanoTime: () => Long):
  import LearnRun.*
  import setup.question

  /** @param isStopped
    *   asked at every step; the round under way is given up then
    * @param onRound
    *   told of every state
    * @return
    *   the last state, or why there is none
    */
  def run(from: LearnState, threads: Int, isStopped: () => Boolean)(
      onRound: LearnState => Unit
  ): Either[String, LearnState] =
    val workers = Workers(threads)
    try
      for
        task <- setup.task
        learner = setup.algorithm.learner(
          task.observations,
          task.actions,
          task.count,
          question.learner,
          question.seed,
          workers
        )
        _ = if from.rounds == 0 then DuelTask.times.foreach(learner.actor.ignore)
        _     <- folder.fold(Right(()))(LearnFile.load(_, from, learner))
        state <- rounds(from, task, learner, isStopped, onRound)
      yield state
    finally workers.close()

  private def rounds(
      from: LearnState,
      task: DuelTask,
      learner: Learner,
      isStopped: () => Boolean,
      onRound: LearnState => Unit
  ): Either[String, LearnState] =
    val training  = Training(task, learner, setup.stepsPerRound)
    val evaluator = setup.evaluator(batch)
    var state     = from
    def save()    = folder.fold(Right(()))(LearnFile.write(_, question, state, learner))
    var savedAt   = nanoTime()

    var mistake: Either[String, Unit] = if from.rounds == 0 then save() else Right(())
    while mistake.isRight && state.rounds < setup.rounds && !isStopped() do
      training.round(state.rounds, isStopped) match
        case Left(reason)   => mistake = Left(reason)
        case Right(None)    => ()
        case Right(Some(_)) =>
          state = state.copy(rounds = state.rounds + 1)
          val isLast = state.rounds == setup.rounds
          if isLast || state.rounds % setup.roundsPerScore == 0 then
            val weights = DuelTask.parameters(learner.actor)
            val tally   =
              evaluator.tallies(Vector(setup.policy(weights).parameters), 0 until question.episodes).head
            val steps  = state.rounds * setup.stepsOfRound
            val better = state.best.forall: best =>
              if setup.objective.direction == Direction.Minimise then tally.mean < best.mean
              else tally.mean > best.mean
            state = state.copy(
              scores = state.scores :+ LearnScore(steps, tally.mean, tally.sd),
              best = if better then Some(LearnBest(steps, tally.mean, weights)) else state.best
            )
          if isLast || nanoTime() - savedAt > SaveNanos then
            mistake = save()
            savedAt = nanoTime()
          onRound(state)
    // A round that was given up is in the learner already, and so is not saved: it is learned again.
    mistake.map(_ => state)

object LearnRun:
  private val SaveNanos = 10_000_000_000L
