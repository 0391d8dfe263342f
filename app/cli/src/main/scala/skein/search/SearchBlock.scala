package skein.search

import scala.collection.immutable.ArraySeq
import skein.bytes.Codec
import skein.optimise.{RunningStats, ValueEvaluator}
import skein.search.BlockBytes.given
import skein.units.Expect

/** A part of an evaluator's call, which any process with an equal question answers with identical bits: some
  * candidates on some episodes.
  *
  * @param isWhole whether the block contains all episodes of the call, so that statistics suffice; else every
  *   episode's value is needed
  */
final case class SearchBlock(
    judge: Judge,
    candidates: Vector[Vector[Double]],
    episodes: Range,
    isWhole: Boolean
):
  import SearchBlock.{Answer, given}

  def bytes: ArraySeq[Byte] = BlockBytes.of(this)

  /** Encodes each candidate's statistics, or, for one candidate, every episode's value. */
  def answer(by: Judge => ValueEvaluator): ArraySeq[Byte] = BlockBytes.of:
    if isWhole then Answer.Tallies(by(judge).tallies(candidates, episodes))
    else
      val values = by(judge).valuesUnless(() => false)(candidates, episodes).get
      Answer.Values(values.flatMap(_.toVector))

  private def read(answer: ArraySeq[Byte]): Either[String, Answer] =
    BlockBytes
      .read[Answer](answer, "an answer to a block of a search")
      .filterOrElse(
        {
          case Answer.Tallies(of) => isWhole && of.size == candidates.size
          case Answer.Values(of)  => !isWhole && of.size == episodes.size
        },
        s"expected the answer to $candidates on $episodes, got ${answer.length} bytes of another"
      )

object SearchBlock:
  private enum Answer:
    case Tallies(of: Vector[RunningStats])
    case Values(of: Vector[Double])

  private given Codec[Judge]  = Codec.derived
  private given Codec[Range]  = Codec[(Int, Int)].imap[Range](_ until _)(range => (range.start, range.end))
  private given Codec[Answer] = Codec.derived
  private given Codec[SearchBlock] = Codec.derived

  /** Bytes of one candidate's encoded statistics. */
  private val OfTally = 20

  /** Maximum size of a block's question in bytes, and of its answer. */
  private val MostBytes = 512 << 10

  /** Number of candidates in a block with SIMD: this, or twice this. */
  private val Lanes = 16

  /** Maximum number of episodes in one block. */
  val MostEpisodes: Int = MostBytes / 8

  /** Divides a call into blocks of at most `atMost` episodes, over all their candidates; into at least
    * sixteen, unless they would become too small. A candidate that does not fit into a block is divided by
    * episodes.
    */
  def cut(
      judge: Judge,
      candidates: Vector[Vector[Double]],
      episodes: Range,
      atMost: Int
  ): Vector[SearchBlock] =
    val total = candidates.size.toLong * episodes.size
    val most  = (total / 16).max(atMost / 256).max(1).min(atMost.min(MostEpisodes)).toInt
    if episodes.size > most then
      for candidate <- candidates; from <- Vector.range(episodes.start, episodes.end, most)
      yield SearchBlock(judge, Vector(candidate), from until (from + most).min(episodes.end), isWhole = false)
    else
      val fit     = (MostBytes / (4 + 8 * candidates.head.size)).max(1).min(MostBytes / OfTally)
      val several = (most / episodes.size).max(1).min(fit)
      val group   = if several > Lanes then several / Lanes * Lanes else several
      candidates.grouped(group).map(SearchBlock(judge, _, episodes, isWhole = true)).toVector

  /** Combines the answers of a call's blocks.
    *
    * @param episodes number of episodes of the call
    * @return statistics for each candidate in order, bit-identical to those of an undivided call; Left says
    *   what was wrong
    */
  def together(
      blocks: Vector[SearchBlock],
      answers: Vector[ArraySeq[Byte]],
      episodes: Int
  ): Either[String, Vector[RunningStats]] =
    for read <- Expect.each(blocks.zip(answers))((block, answer) => block.read(answer))
    yield
      val tallies = Vector.newBuilder[RunningStats]
      var parts   = Vector.empty[Double]
      read.foreach:
        case Answer.Tallies(of) => tallies ++= of
        case Answer.Values(of)  =>
          parts ++= of
          if parts.size == episodes then
            tallies += RunningStats.of(episodes)(parts)
            parts = Vector.empty
      tallies.result()

  /** @return Left says what was expected and what was received */
  def read(bytes: ArraySeq[Byte]): Either[String, SearchBlock] =
    BlockBytes
      .read[SearchBlock](bytes, "a block of a search")
      .filterOrElse(
        block =>
          import block.{candidates, episodes}
          val (from, until) = (episodes.start.toLong, episodes.end.toLong)
          from >= 0 && until > from && until - from <= MostEpisodes &&
          candidates.nonEmpty && candidates.forall(_.size == candidates.head.size)
        ,
        s"expected a block of a search, got ${bytes.length} bytes that are none"
      )
