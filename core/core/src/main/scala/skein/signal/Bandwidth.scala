package skein.signal

import skein.units.*

/** A rate limit for one direction of a line, preceded by a queue of limited size.
  *
  * @param bitsPerSecond rate of payload; the headers of a network's own layers are not counted
  * @param queueBytes maximum size of the first-in, first-out queue; bytes that do not fit wait at the sender
  */
final case class Bandwidth(bitsPerSecond: Long, queueBytes: Int):
  require(bitsPerSecond > 0 && queueBytes > 0, s"a line has a rate and a queue above zero: $this")

  /** Time for which the line sends this number of bytes. */
  def timeOf(bytes: Long): Span = Span.ofSeconds(bytes * 8.0 / bitsPerSecond)

object Bandwidth:
  /** Size of an Ethernet frame, the smallest queue, because a whole packet must fit. */
  private val FrameBytes = 1500

  private val LeastQueueBytes = 2 * FrameBytes

  /** Maximum time in which a full queue is sent; a longer queue would delay everything permanently. */
  private val MostQueue = Span.ofSeconds(60)

  /** A line with a queue that is sent in 5 ms, but of at least 3,000 bytes. CoDel limits a queue to this
    * standing delay (RFC 8289, section 4.3).
    */
  def ofBitsPerSecond(bitsPerSecond: Long): Bandwidth =
    Bandwidth(bitsPerSecond, (bitsPerSecond / 8 / 200).max(LeastQueueBytes).min(Int.MaxValue).toInt)

  val form: String =
    "a rate from 1kbit to 100gbit such as 50mbit, or with a queue such as " +
      s"50mbit/64kB, from ${FrameBytes}B up to 1GB and to what the rate sends in ${MostQueue.toSeconds.toInt} s"

  /** Reads `50mbit` (bit, kbit, mbit, gbit per second, in powers of 1000), or `50mbit/64kB` with the size of
    * the queue in B, kB, MB or GB: at least an Ethernet frame, at most 1 GB and a minute of the rate. Left
    * states what was expected and what was received.
    */
  def parse(text: String): Either[String, Bandwidth] =
    val bandwidth = text match
      case s"$rate/$queue" =>
        for
          bits  <- amount(rate, bitUnits).filter(inRange)
          bytes <- amount(queue, byteUnits).filter(bytes => bytes >= FrameBytes && bytes <= 1_000_000_000L)
          limit = Bandwidth(bits, bytes.toInt)
          if limit.timeOf(bytes) <= MostQueue
        yield limit
      case rate => amount(rate, bitUnits).filter(inRange).map(ofBitsPerSecond)
    bandwidth.toRight(s"expected $form, got '$text'")

  private def inRange(bits: Long) = bits >= 1000 && bits <= 100_000_000_000L

  private val bitUnits  = Map("bit" -> 1L, "kbit" -> 1000L, "mbit" -> 1_000_000L, "gbit" -> 1_000_000_000L)
  private val byteUnits = Map("B" -> 1L, "kB" -> 1000L, "MB" -> 1_000_000L, "GB" -> 1_000_000_000L)
  private val quantity  = """(\d{1,12}(?:\.\d{1,9})?)([a-zA-Z]+)""".r

  private def amount(text: String, units: Map[String, Long]): Option[Long] = text match
    case quantity(number, unit) => units.get(unit).map(size => math.round(number.toDouble * size))
    case _                      => None
