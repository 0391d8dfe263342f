package skein.cluster

import scala.collection.immutable.ArraySeq

/** Computes blocks of one question, for one thread at a time. Pure: equal work gives equal bytes in every
  * process.
  */
trait BlockSolver:

  /** @param work a block's work, in the encoding of the question's coordinator */
  def solve(work: ArraySeq[Byte]): ArraySeq[Byte]

/** Makes solvers from a question's encoded bytes. */
trait BlockSolverFactory:

  /** @param question the question, as its coordinator encoded it
    * @return a function that makes a solver for each core; Left says in a line why this process cannot answer
    *   the question
    */
  def of(question: ArraySeq[Byte]): Either[String, () => BlockSolver]
