package skein.budget

import scala.collection.immutable.ArraySeq
import skein.bytes.Codec
import skein.optimise.RunningStats
import skein.search.BlockBytes
import skein.search.BlockBytes.given
import skein.signal.LatencyDistribution

/** Some cells of a budget's map, which any process with an equal question simulates with identical bits.
  *
  * @param number index of the subject, from 0
  * @param episodes number of episodes for each link
  */
final case class BudgetBlock(number: Int, links: Vector[LatencyDistribution], episodes: Int):

  def bytes: ArraySeq[Byte] = BlockBytes.of(this)

  /** Simulates the cells and encodes each link's statistics.
    *
    * @return Left says why there is no answer
    */
  def answer(subjects: Vector[BudgetSubject]): Either[String, ArraySeq[Byte]] =
    for
      one <- subjects.lift(number).toRight(s"expected one of ${subjects.size} subjects, got number $number")
      tallies <- one.tallies(BudgetCells(links, episodes))
    yield BlockBytes.of(tallies)

  /** Decodes the statistics of an answer, one per link. */
  def tallies(answer: ArraySeq[Byte]): Either[String, Vector[RunningStats]] =
    BlockBytes
      .read[Vector[RunningStats]](answer, "an answer to a block of a budget")
      .filterOrElse(_.size == links.size, s"expected an answer for ${links.size} cells, got one for others")

object BudgetBlock:
  private given Codec[LatencyDistribution] = Codec.derived
  private given Codec[BudgetBlock]         = Codec.derived

  /** Decodes a block.
    *
    * @return Left says what was expected and what was received
    */
  def read(bytes: ArraySeq[Byte]): Either[String, BudgetBlock] =
    BlockBytes.read[BudgetBlock](bytes, "a block of a budget")
