package skein.cli

import java.nio.charset.StandardCharsets.UTF_8
import java.util.Locale
import scala.collection.immutable.ArraySeq
import skein.budget.ClusterSubject
import skein.cluster.{BlockSolver, BlockSolverFactory}
import skein.scenario.Scenarios
import skein.search.VerifiedQuestion

/** The kinds of questions that commands send to workers. A question's first line names its kind. */
private[cli] enum QuestionKind:
  case Search, Budget, Torture, Spread, Learn

  private def name = toString.toLowerCase(Locale.ROOT)

  def of(question: ArraySeq[Byte]): ArraySeq[Byte] =
    ArraySeq.unsafeWrapArray(s"$name\n".getBytes(UTF_8)) ++ question

private[cli] object QuestionKind:

  /** Answers every kind, about scenarios known to this process. */
  def solvers(using Scenarios): BlockSolverFactory = asked =>
    val (line, question) = asked.splitAt(asked.indexOf('\n'.toByte).max(0))
    val told             = String(line.toArray, UTF_8)
    val theirs           = question.drop(1)
    values.find(_.name == told) match
      case Some(Search)  => VerifiedQuestion.solvers.of(theirs)
      case Some(Budget)  => ClusterSubject.solvers.of(theirs)
      case Some(Torture) => TortureQuestion.read(theirs).map(ready => () => (ready.answer(_)): BlockSolver)
      case Some(Spread)  => SpreadQuestion.solvers.of(theirs)
      case Some(Learn)   => LearnWork.solvers.of(theirs)
      case None          =>
        val known = values.map(_.name).mkString(", ")
        Left(s"expected a question of one of $known, got one of '${told.take(40)}'")
