package skein.search

import java.nio.{BufferUnderflowException, ByteBuffer}
import scala.collection.immutable.ArraySeq
import skein.optimise.{RunningStats, ValueEvaluator}

/** A part of a call of an evaluator, which any process with the same question answers with the same bits: so many
  * candidates on so many episodes.
  *
  * @param isWhole
  *   whether the episodes are all of the call, so that tallies can be told; else each episode's value is
  */
final case class SearchBlock(
    judge: Judge,
    candidates: Vector[Vector[Double]],
    episodes: Range,
    isWhole: Boolean
):
  /** Big-endian: judge and whether it is whole, a byte each; first episode, end, candidates and parameters of each, 4
    * bytes each; the parameters, 8 bytes each.
    */
  def bytes: ArraySeq[Byte] =
    val axes = candidates.head.size
    val out  = ByteBuffer.allocate(SearchBlock.Head + 8 * axes * candidates.size)
    out.put(judge.ordinal.toByte).put(if isWhole then 1: Byte else 0: Byte)
    out.putInt(episodes.start).putInt(episodes.end).putInt(candidates.size).putInt(axes)
    for candidate <- candidates; value <- candidate do out.putDouble(value)
    ArraySeq.unsafeWrapArray(out.array)

  /** Of each candidate its tally ([[StatsBytes]]), or of each candidate and episode its value (8 bytes). */
  def answer(by: Judge => ValueEvaluator): ArraySeq[Byte] =
    if isWhole then StatsBytes.write(by(judge).tallies(candidates, episodes))
    else
      val values = by(judge).valuesUnless(() => false)(candidates, episodes).get
      val out    = ByteBuffer.allocate(8 * candidates.size * episodes.size)
      for each <- values; value <- each do out.putDouble(value)
      ArraySeq.unsafeWrapArray(out.array)

  /** Bytes of an answer. */
  private def expected: Int =
    candidates.size * (if isWhole then StatsBytes.Each else 8 * episodes.size)

object SearchBlock:
  private val Head = 18

  /** Of what a block asks, and of its answer. */
  private val MostBytes = 512 << 10

  /** Candidates fly side by side by lanes: so many of them, or twice. */
  private val Lanes = 16

  /** Episodes of a block at most. */
  val MostEpisodes: Int = MostBytes / 8

  /** Cuts a call into blocks of at most so many episodes, over all their candidates; into sixteen or more, where they do
    * not become too small. Candidates that would not fit are parted by episodes.
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
      val fit     = (MostBytes / (8 * candidates.head.size.max(1))).max(1).min(MostBytes / StatsBytes.Each)
      val several = (most / episodes.size).max(1).min(fit)
      val group   = if several > Lanes then several / Lanes * Lanes else several
      candidates.grouped(group).map(SearchBlock(judge, _, episodes, isWhole = true)).toVector

  /** Puts the answers of a call's blocks together.
    *
    * @param episodes
    *   of the call
    * @return
    *   a tally for each candidate in their order, equal to an undivided call's to the bit; or what was wrong
    */
  def together(
      blocks: Vector[SearchBlock],
      answers: Vector[ArraySeq[Byte]],
      episodes: Int
  ): Either[String, Vector[RunningStats]] =
    blocks.zip(answers).find((block, answer) => answer.length != block.expected) match
      case Some((block, answer)) =>
        Left(s"expected an answer of ${block.expected} bytes to a block, came ${answer.length}")
      case None =>
        val tallies = Vector.newBuilder[RunningStats]
        var parts   = Vector.empty[Double]
        for (block, answer) <- blocks.zip(answers) do
          val in = ByteBuffer.wrap(answer.toArray)
          if block.isWhole then
            for _ <- block.candidates do tallies += StatsBytes.read(in)
          else
            parts ++= Vector.fill(block.episodes.size)(in.getDouble)
            if parts.size == episodes then
              tallies += RunningStats.of(episodes)(parts)
              parts = Vector.empty
        Right(tallies.result())

  /** @return or what was expected, and what came */
  def read(bytes: ArraySeq[Byte]): Either[String, SearchBlock] =
    val in = ByteBuffer.wrap(bytes.toArray)
    try
      val (judge, whole) = (in.get.toInt, in.get.toInt)
      val (from, end)    = (in.getInt, in.getInt)
      val (count, axes)  = (in.getInt, in.getInt)
      val isSound        =
        judge >= 0 && judge < Judge.values.length && from >= 0 && end > from && end - from <= MostEpisodes &&
          count > 0 && axes >= 0 && in.remaining == 8L * count * axes
      Either.cond(
        isSound,
        SearchBlock(
          Judge.fromOrdinal(judge),
          Vector.fill(count)(Vector.fill(axes)(in.getDouble)),
          from until end,
          whole != 0
        ),
        s"expected a block of a search, came ${bytes.length} bytes that are none"
      )
    catch
      case _: BufferUnderflowException => Left(s"a block of a search is cut off after ${bytes.length} bytes")
