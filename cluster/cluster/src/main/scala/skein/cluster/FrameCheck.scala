package skein.cluster

import java.nio.ByteBuffer

/** Checks the frame lengths of a Pekko connection: four letters, a stream's number, and frames after their
  * lengths in four bytes each, little-endian. Pekko 1.2.1 checks no length: it reads endlessly if a length is
  * below zero or close to 2³¹, and waits for the whole of a frame that is too long. Mutable; one for each
  * connection.
  *
  * @param most maximum number of bytes of a frame
  */
private[cluster] final class FrameCheck(most: Int):
  private var skips  = FrameCheck.Header
  private var length = 0
  private var digits = 0

  /** Checks the next bytes, between the buffer's position and its limit, without consuming them.
    *
    * @return an invalid length, if there is one
    */
  def refused(bytes: ByteBuffer): Option[Int] =
    var at    = bytes.position()
    var wrong = Option.empty[Int]
    while wrong.isEmpty && at < bytes.limit() do
      if skips > 0 then
        val passed = skips.min(bytes.limit() - at)
        skips -= passed
        at += passed
      else
        length |= (bytes.get(at) & 0xff) << 8 * digits
        digits += 1
        at += 1
        if digits == 4 then
          if length < 0 || length > most then wrong = Some(length)
          else skips = length
          length = 0
          digits = 0
    wrong

private object FrameCheck:
  private val Header = 5
