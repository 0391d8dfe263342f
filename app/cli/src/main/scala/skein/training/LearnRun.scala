package skein.training

import java.nio.file.Path
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, ExecutionContext, Future, blocking}
import scala.util.Try
import skein.learn.{SideTask, Learner, Training, BatchThreads}
import skein.optimise.{Direction, Evaluator, RunningStats}
import skein.scenario.Scenarios
import skein.units.OwnFailure

/** The end of learning.
  *
  * @param failure why it ended early, unless it was stopped
  */
final case class Learned(state: LearnState, failure: Option[String]):

  def unfailing: Either[String, LearnState] = failure.toLeft(state)

/** Learns round by round, evaluates the policy from time to time, and keeps its state on disk.
  *
  * @param judge evaluates policies, given by their parameters
  * @param folder directory for its state; without one, nothing is kept
  * @param isElsewhere whether other processes evaluate: then learning continues meanwhile, with an identical
  *   result
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

  /** @param isStopped checked at every step, from any thread; true abandons the current round, and a pending
    *   evaluation
    * @param onRound called with every state
    * @return the progress; Left says why it could not begin
    */
  def run(from: LearnState, threads: Int, isStopped: () => Boolean)(
      onRound: LearnState => Unit
  )(using Scenarios): Either[String, Learned] =
    setup.task.flatMap: task =>
      try learn(from, threads, isStopped, onRound, task)
      finally task.close()

  private def learn(
      from: LearnState,
      threads: Int,
      isStopped: () => Boolean,
      onRound: LearnState => Unit,
      task: SideTask
  ): Either[String, Learned] =
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
        _ <- folder.fold(Right(()))(LearnFile.load(_, from, learner))
      yield rounds(from, task, learner, isStopped, onRound)
    finally workers.close()

  private def rounds(
      from: LearnState,
      task: SideTask,
      learner: Learner,
      isStopped: () => Boolean,
      onRound: LearnState => Unit
  ): Learned =
    val training = Training(task, learner, setup.stepsPerRound)
    var state    = from
    var judging  = Option.empty[Judging]
    var isCut    = false
    // A stored or returned state has no evaluation pending.
    def judged(): Unit = for policy <- judging do
      judging = None
      Await.result(policy.came, Duration.Inf) match
        case Some(tally) => state = scored(state, policy, tally)
        case None        => isCut = true
    // Not after a cut evaluation, so that it is repeated.
    def save() =
      judged()
      folder.filterNot(_ => isCut).fold(Right(()))(LearnFile.write(
        _,
        LearnFile(LearnFile.Version, question, state, files, setup.probe),
        learner
      ))
    var savedAt = nanoTime()

    def round(): Either[String, Unit] = training.round(state.rounds, isStopped).flatMap:
      case None    => Right(())
      case Some(_) =>
        state = state.copy(rounds = state.rounds + 1)
        val isLast = state.rounds == setup.rounds
        if isLast || state.rounds % setup.roundsPerScore == 0 then
          judged()
          judging = Some(judgingOf(
            state.rounds * setup.stepsOfRound,
            SideTask.parameters(learner.actor),
            isStopped
          ))
          if isLast || !isElsewhere then judged()
        val isDue = isLast || nanoTime() - savedAt > SaveNanos
        val saved = if isDue then save() else Right(())
        if isDue then savedAt = nanoTime()
        onRound(state)
        saved

    var mistake: Either[String, Unit] = if from.rounds == 0 then told(save()) else Right(())
    while mistake.isRight && state.rounds < setup.rounds && !isStopped() do mistake = told(round())
    // The learner has already changed in an abandoned round, so its state is not saved: the round is
    // repeated.
    val ended = mistake.flatMap(_ => told(Right(judged())))
    // All rounds done, it would count as finished, without its last evaluation.
    Learned(
      if isCut then state.copy(rounds = state.rounds.min(setup.rounds - 1)) else state,
      ended.left.toOption
    )

  /** Runs a step; an exception of user code ends learning, and keeps the state. */
  private def told(step: => Either[String, Unit]): Either[String, Unit] =
    try step
    catch case failure: OwnFailure => Left(failure.getMessage)

  private def judgingOf(steps: Long, weights: Vector[Double], isStopped: () => Boolean): Judging =
    def tally = judge
      .talliesUnless(isStopped)(Vector(setup.policy(weights).parameters), 0 until question.episodes)
      .map(_.head)
    Judging(
      steps,
      weights,
      if isElsewhere then Future(blocking(tally))(using ExecutionContext.global)
      else Future.fromTry(Try(tally))
    )

  private def scored(state: LearnState, policy: Judging, tally: RunningStats): LearnState =
    import policy.*
    val better = state.best.forall: best =>
      if setup.game.direction == Direction.Minimise then tally.mean < best.mean
      else tally.mean > best.mean
    state.copy(
      scores = state.scores :+ LearnScore(steps, tally.mean, tally.sd),
      best = if better then Some(LearnBest(steps, tally.mean, weights)) else state.best
    )

object LearnRun:
  /** A policy of an earlier step count, and its pending evaluation, None if a stop cancels it. */
  private final case class Judging(steps: Long, weights: Vector[Double], came: Future[Option[RunningStats]])

  private val SaveNanos = 10_000_000_000L
