package skein.search

import scala.collection.immutable.ArraySeq
import skein.bytes.Codec
import skein.optimise.RunningStats

/** What blocks ask and answer, as [[Codec]] writes it. */
private[skein] object BlockBytes:
  given Codec[RunningStats] = Codec.derived

  def of[A: Codec](value: A): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(Codec.bytes(value))

  /** @param what the bytes should be, in words
    * @return or what was expected, and what came
    */
  def read[A: Codec](bytes: ArraySeq[Byte], what: String): Either[String, A] =
    Codec.message[A](bytes.toArray).left.map(wrong => s"expected $what: $wrong")
