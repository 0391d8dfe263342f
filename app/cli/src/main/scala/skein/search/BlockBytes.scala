package skein.search

import scala.collection.immutable.ArraySeq
import skein.bytes.Codec
import skein.optimise.RunningStats

/** Encodes the questions and answers of blocks with [[Codec]]. */
private[skein] object BlockBytes:
  given Codec[RunningStats] = Codec.derived

  def of[A: Codec](value: A): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(Codec.bytes(value))

  /** @param what the bytes should be, in words
    * @return Left says what was expected and what was received
    */
  def read[A: Codec](bytes: ArraySeq[Byte], what: String): Either[String, A] =
    Codec.message[A](bytes.toArray).left.map(wrong => s"expected $what: $wrong")
