package skein.blocks

import java.nio.ByteBuffer
import java.security.MessageDigest
import scala.collection.immutable.ArraySeq

/** A part of a question's work. Computing it is pure: any process, at any time, gets identical bytes.
  *
  * @param number the coordinator's number of the block, from 0
  * @param work the input of the computation, in the encoding of the question's solver
  */
final case class Block(number: Long, work: ArraySeq[Byte]):
  val key: BlockKey = BlockKey.of(work)

/** Identifies a block by its content, so that a restarted coordinator recognises answered blocks: the first
  * 128 bits of the work's SHA-256.
  */
final case class BlockKey(high: Long, low: Long)

object BlockKey:
  val Bytes = 16

  def of(work: ArraySeq[Byte]): BlockKey =
    val digest = ByteBuffer.wrap(MessageDigest.getInstance("SHA-256").digest(work.toArray))
    BlockKey(digest.getLong, digest.getLong)
