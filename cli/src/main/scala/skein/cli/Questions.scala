package skein.cli

import java.nio.charset.StandardCharsets.UTF_8
import scala.collection.immutable.ArraySeq
import skein.budget.ClusterSubject
import skein.cluster.{BlockSolver, BlockSolverFactory}
import skein.scenario.Scenarios
import skein.search.VerifiedQuestion

/** What commands ask their workers. A question's first line says of which kind it is. */
private[cli] object Questions:
  private val Search  = "search"
  private val Torture = "torture"
  private val Budget  = "budget"
  private val Spread  = "spread"
  private val Learn   = "learn"

  def search(question: ArraySeq[Byte]): ArraySeq[Byte] = of(Search, question)

  def budget(question: ArraySeq[Byte]): ArraySeq[Byte] = of(Budget, question)

  def torture(question: TortureQuestion): ArraySeq[Byte] = of(Torture, question.bytes)

  def spread(question: SpreadQuestion): ArraySeq[Byte] = of(Spread, question.bytes)

  def learn(question: ArraySeq[Byte]): ArraySeq[Byte] = of(Learn, question)

  private def of(kind: String, question: ArraySeq[Byte]) =
    ArraySeq.unsafeWrapArray(s"$kind\n".getBytes(UTF_8)) ++ question

  /** Answers every kind, about scenarios that are known here. */
  def solvers(using Scenarios): BlockSolverFactory = asked =>
    val (kind, question) = asked.splitAt(asked.indexOf('\n'.toByte).max(0))
    String(kind.toArray, UTF_8) match
      case Search  => VerifiedQuestion.solvers.of(question.drop(1))
      case Budget  => ClusterSubject.solvers.of(question.drop(1))
      case Torture =>
        TortureQuestion.read(question.drop(1)).map(ready => () => (ready.answer(_)): BlockSolver)
      case Spread => SpreadQuestion.solvers.of(question.drop(1))
      case Learn  => LearnWork.solvers.of(question.drop(1))
      case other  =>
        Left(
          s"expected a question of $Search, $Budget, $Torture, " +
            s"$Spread or $Learn, came one of '${other.take(40)}'"
        )
