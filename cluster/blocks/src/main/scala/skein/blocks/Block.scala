package skein.blocks

import java.nio.ByteBuffer
import java.security.MessageDigest
import scala.collection.immutable.ArraySeq

/** A part of a question's work. Computing it is pure: whoever does it, and however often, gets the same
  * bytes.
  *
  * @param number counted by the coordinator, from 0
  * @param work what to compute, as the question's solver reads it
  */
final case class Block(number: Long, work: ArraySeq[Byte]):
  val key: BlockKey = BlockKey.of(work)

/** Names a block by what it asks, so that a coordinator that was started again knows what it has: the first
  * 128 bits of the work's SHA-256.
  */
final case class BlockKey(high: Long, low: Long)

object BlockKey:
  val Bytes = 16

  def of(work: ArraySeq[Byte]): BlockKey =
    val digest = ByteBuffer.wrap(MessageDigest.getInstance("SHA-256").digest(work.toArray))
    BlockKey(digest.getLong, digest.getLong)
