package skein.budget

import java.nio.ByteBuffer
import scala.collection.immutable.ArraySeq
import skein.optimise.RunningStats
import skein.search.{JsonText, StatsBytes}
import skein.signal.LatencyDistribution
import skein.units.Span
import upickle.default.{ReadWriter, readwriter}

/** Some cells of a budget's map, which any process that was asked the same question flies to the same bits.
  *
  * @param number
  *   of the subject, from 0
  * @param episodes
  *   of each link
  */
final case class BudgetBlock(number: Int, links: Vector[LatencyDistribution], episodes: Int)
    derives ReadWriter:

  def bytes: ArraySeq[Byte] = JsonText.bytes(this)

  /** Of each link what it came to, as [[StatsBytes]].
    *
    * @return
    *   or why there is none
    */
  def answer(subjects: Vector[BudgetSubject]): Either[String, ArraySeq[Byte]] =
    for
      one <- subjects.lift(number).toRight(s"expected one of ${subjects.size} subjects, came number $number")
      tallies <- one.tallies(BudgetCells(links, episodes))
    yield StatsBytes.write(tallies)

  /** What an answer says. */
  def tallies(answer: ArraySeq[Byte]): Either[String, Vector[RunningStats]] =
    val expected = StatsBytes.Each * links.size
    val in       = ByteBuffer.wrap(answer.toArray)
    Either.cond(
      answer.length == expected,
      Vector.fill(links.size)(StatsBytes.read(in)),
      s"expected an answer of $expected bytes to a block, came ${answer.length}"
    )

object BudgetBlock:
  private given ReadWriter[Span]                = readwriter[Long].bimap(_.toNanos, Span.ofNanos)
  private given ReadWriter[LatencyDistribution] = ReadWriter.derived

  /** @return or what was expected, and what came */
  def read(bytes: ArraySeq[Byte]): Either[String, BudgetBlock] =
    JsonText.read[BudgetBlock](bytes, "a block of a budget")
