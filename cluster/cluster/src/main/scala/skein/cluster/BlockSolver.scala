package skein.cluster

import scala.collection.immutable.ArraySeq

/** Computes blocks of one question, for one thread at a time. Pure: the same work gives the same bytes,
  * whoever does it.
  */
trait BlockSolver:

  /** @param work as the question's coordinator cut it
    */
  def solve(work: ArraySeq[Byte]): ArraySeq[Byte]

/** Reads questions. */
trait BlockSolverFactory:

  /** @param question as its coordinator wrote it
    * @return what makes a solver for each core; or why this process cannot answer the question, in a line
    */
  def of(question: ArraySeq[Byte]): Either[String, () => BlockSolver]
