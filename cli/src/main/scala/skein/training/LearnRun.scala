package skein.training

import java.nio.file.Path
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, ExecutionContext, Future, blocking}
import scala.util.Try
import skein.learn.{SideTask, Learner, Training, BatchThreads}
import skein.optimise.{Direction, Evaluator, RunningStats}
import skein.scenario.Scenarios

/** Learns round by round, judges the policy now and then, and keeps its state on disk.
  *
  * @param judge of policies, by their parameters
  * @param folder without one, nothing is kept
  * @param isElsewhere whether others judge: then learning goes on meanwhile, and comes to the same
  */
final class LearnRun(
    setup: LearnSetup,
    judge: Evaluator,
    folder: Option[Path],
    nanoTime: () => Long,
    isElsewhere: Boolean = false
):
  import LearnRun.*
  import setup.question

  private val files = LearnFile.files(question)

  /** @param isStopped asked at every step; the round under way is given up then
    * @param onRound told of every state
    * @return the last state, or why there is none
    */
  def run(from: LearnState, threads: Int, isStopped: () => Boolean)(
      onRound: LearnState => Unit
  )(using Scenarios): Either[String, LearnState] =
    setup.task.flatMap: task =>
      try learn(from, threads, isStopped, onRound, task)
      finally task.close()

  private def learn(
      from: LearnState,
      threads: Int,
      isStopped: () => Boolean,
      onRound: LearnState => Unit,
      task: SideTask
  ): Either[String, LearnState] =
    val workers = BatchThreads(threads)
    try
      for
        _ <- Right(())
        learner = setup.algorithm.learner(
          task.observations,
          task.actions,
          task.count,
          question.learner,
          question.seed,
          workers
        )
        _ = if from.rounds == 0 then SideTask.times.foreach(learner.actor.ignore)
        _     <- folder.fold(Right(()))(LearnFile.load(_, from, learner))
        state <- rounds(from, task, learner, isStopped, onRound)
      yield state
    finally workers.close()

  private def rounds(
      from: LearnState,
      task: SideTask,
      learner: Learner,
      isStopped: () => Boolean,
      onRound: LearnState => Unit
  ): Either[String, LearnState] =
    val training = Training(task, learner, setup.stepsPerRound)
    var state    = from
    var judging  = Option.empty[Judging]
    // What is on disk or returned waits for nothing.
    def judged(): Unit =
      judging.foreach(policy => state = scored(state, policy))
      judging = None
    def save() =
      judged()
      folder.fold(Right(()))(LearnFile.write(_, question, state, files, learner))
    var savedAt = nanoTime()

    var mistake: Either[String, Unit] = if from.rounds == 0 then save() else Right(())
    while mistake.isRight && state.rounds < setup.rounds && !isStopped() do
      training.round(state.rounds, isStopped) match
        case Left(reason)   => mistake = Left(reason)
        case Right(None)    => ()
        case Right(Some(_)) =>
          state = state.copy(rounds = state.rounds + 1)
          val isLast = state.rounds == setup.rounds
          if isLast || state.rounds % setup.roundsPerScore == 0 then
            judged()
            judging = Some(judgingOf(state.rounds * setup.stepsOfRound, SideTask.parameters(learner.actor)))
            if isLast || !isElsewhere then judged()
          if isLast || nanoTime() - savedAt > SaveNanos then
            mistake = save()
            savedAt = nanoTime()
          onRound(state)
    // A round that was given up is in the learner already, and so is not saved: it is learned again.
    mistake.map: _ =>
      judged()
      state

  private def judgingOf(steps: Long, weights: Vector[Double]): Judging =
    def tally = judge.tallies(Vector(setup.policy(weights).parameters), 0 until question.episodes).head
    Judging(
      steps,
      weights,
      if isElsewhere then Future(blocking(tally))(using ExecutionContext.global)
      else Future.fromTry(Try(tally))
    )

  private def scored(state: LearnState, policy: Judging): LearnState =
    import policy.*
    val tally  = Await.result(came, Duration.Inf)
    val better = state.best.forall: best =>
      if setup.game.direction == Direction.Minimise then tally.mean < best.mean
      else tally.mean > best.mean
    state.copy(
      scores = state.scores :+ LearnScore(steps, tally.mean, tally.sd),
      best = if better then Some(LearnBest(steps, tally.mean, weights)) else state.best
    )

object LearnRun:
  /** A policy as it was after these steps, and how good it turns out to be. */
  private final case class Judging(steps: Long, weights: Vector[Double], came: Future[RunningStats])

  private val SaveNanos = 10_000_000_000L
