package skein.mavlink

import java.security.MessageDigest
import scala.collection.mutable

/** Makes and verifies the signatures of one link: the first 48 bits of a SHA-256 over the key, the frame, the
  * link's number and a time that never runs backwards. One for each link and end; not thread-safe.
  *
  * A frame is refused unless its time is later than that of the previous frame of its system, component and
  * link, or, for the first of these, at most a minute behind this end's time. Times of at most
  * [[Signing.MostStreams]] streams are kept.
  *
  * @param key 32 bytes, equal at both ends
  * @param link the link's number, 0 to 255
  * @param now the present time in units of 10 µs since the start of 2015, UTC: see [[Signing.timeOf]]
  */
final class Signing(key: Array[Byte], link: Int, now: () => Long):
  import Signing.*
  require(key.length == 32, s"expected a key of 32 bytes, got ${key.length}")

  private val secret = key.clone
  private val heard  = mutable.HashMap.empty[(Int, Int, Int), Long]
  private var newest = 0L

  /** The signature to append to a frame that ends with its checksum. */
  private[mavlink] def sign(frame: Array[Byte]): Array[Byte] =
    newest = now().max(newest + 1)
    val stamp = link.toByte +: Array.tabulate(6)(index => (newest >> (8 * index)).toByte)
    stamp ++ digest(frame, stamp)

  /** Whether a frame, up to and including its checksum, has a valid signature and is not a replay. */
  private[mavlink] def accepts(
      frame: Array[Byte],
      signature: Array[Byte],
      system: Int,
      component: Int
  ): Boolean =
    val (stamp, told) = signature.splitAt(7)
    val at            = stamp.drop(1).zipWithIndex.map((byte, index) => (byte & 0xffL) << (8 * index)).sum
    val stream        = (system, component, stamp(0) & 0xff)
    val isLater       = heard.get(stream).fold(at + Tolerance > now() && heard.size < MostStreams)(at > _)
    val accepted      = MessageDigest.isEqual(told, digest(frame, stamp)) && isLater
    if accepted then
      heard(stream) = at
      newest = newest.max(at)
    accepted

  private def digest(frame: Array[Byte], stamp: Array[Byte]): Array[Byte] =
    val sha = MessageDigest.getInstance("SHA-256")
    Seq(secret, frame, stamp).foreach(sha.update)
    sha.digest().take(6)

object Signing:
  /** Maximum number of streams (system, component and link) whose times are remembered. */
  val MostStreams = 1024

  private val Tolerance = 6_000_000L

  /** Converts a Unix time in milliseconds to a signature's time. */
  def timeOf(unixMillis: Long): Long = (unixMillis - 1_420_070_400_000L) * 100
