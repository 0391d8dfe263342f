package skein.forward

import skein.signal.{Impairment, Retransmission}
import skein.simd.WorldRandom
import skein.units.{Span, eachBelow}

/** A link that loses packets, as seen over TCP: a lost message is sent again after a time-out, which doubles
  * each time, and arrives later by the sum of these. A loss is never detected by later packets, because there
  * are none: a vehicle has few unanswered commands, and every request has its own connection.
  *
  * Independent losses are drawn for each message and try. In bursts and outages all packets are lost; bursts
  * are independent in the two directions.
  *
  * The number of tries is limited, and the last try always succeeds; more tries would be needed with a
  * probability of 2 · 10^−5^.
  *
  * @param share share of packets that are lost independently
  * @param bursts mean duration of bursts and of the time between them, s
  * @param outages duration of outages, and mean time between them, s
  * @param timeout the first time-out ([[skein.signal.Retransmission.timeout]]), a multiple of
  *   [[DelayTable.GrainNs]]
  * @param mostTries maximum number of times that a message is sent again
  */
final class LossyDelays private (
    private[skein] val base: TabledDelays,
    share: Double,
    bursts: Option[(lastS: Double, betweenS: Double)],
    outages: Option[(lastS: Double, betweenS: Double)],
    timeout: Span,
    private[skein] val mostTries: Int
) extends TabledDelays:
  import LossyDelays.*

  private[skein] def timeoutNs: Long = timeout.toNanos

  /** A message is lost if the low bits of its random number are below this; the upper bits choose the delay.
    */
  private[skein] val lossThreshold: Int = math.round(share * (1 << DelayTable.Drop)).toInt

  /** Whether losses depend on the time of sending. */
  private[skein] val isTimed: Boolean = bursts.isDefined || outages.isDefined

  def maxS: Float = base.maxS + longest(timeout, mostTries).toSeconds.toFloat

  private[skein] def stretches(worldKey: Int): TableStretch = base.stretches(worldKey)

  private[skein] def isConstant: Boolean = base.isConstant

  private val last = ThreadLocal.withInitial[LossTimes](() => times(0))

  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
    var lossTimes = last.get
    if lossTimes.worldKey != worldKey then
      lossTimes = times(worldKey)
      last.set(lossTimes)
    val bits = WorldRandom.bits(Delays.keyOf(worldKey, line), step * Delays.Lines + line % Delays.Lines)
    base.delayNs(worldKey, line, step, number, sentAtNs) + waitNs(lossTimes, bits, line, sentAtNs)

  /** The intervals in which one world's link loses everything. */
  private[skein] def times(worldKey: Int): LossTimes = LossTimes(
    worldKey,
    Vector(BurstsToServer, BurstsToClient).map(line =>
      bursts.map(LossStretches(worldKey, line, _, isFixed = false))
    ),
    outages.map(LossStretches(worldKey, Outages, _, isFixed = true))
  )

  /** Time from the first try until the successful one, ns.
    *
    * @param bits the random number of the message
    */
  private[skein] def waitNs(times: LossTimes, bits: Int, line: Int, sentAtNs: Long): Long =
    Retransmission
      .wait(timeout, mostTries): (tries, waited) =>
        val drawn = if tries == 0 then bits else WorldRandom.bits(bits, tries)
        (drawn & LowBits) < lossThreshold || times.isLost(line & 1, sentAtNs + waited.toNanos)
      .toNanos

object LossyDelays:
  private val LowBits = (1 << DelayTable.Drop) - 1

  // Lines without messages: their random numbers determine when everything is lost.
  private val BurstsToServer = Delays.Stretch + 1
  private val BurstsToClient = Delays.Stretch + 2
  private val Outages        = Delays.Stretch + 3

  private val Chance = 2e-5

  private def longest(timeout: Span, tries: Int): Span = Retransmission.wait(timeout, tries)((_, _) => true)

  /** Adds losses to a link's delays; without any losses, returns the base itself.
    *
    * @param timeoutS the first time-out
    * @param packetsPerS packets of all connections in one direction, which converts the length of bursts from
    *   packets to time. If packets are sent at equal distances, the chain of losses equals that of a live
    *   link
    */
  def of(
      base: TabledDelays,
      impairments: Seq[Impairment],
      timeoutS: Double,
      packetsPerS: Double
  ): TabledDelays =
    val loss   = impairments.collectFirst { case loss: Impairment.Loss if loss.share > 0 => loss }
    val outage = impairments.collectFirst { case outage: Impairment.Outage => outage }
    // From packet to packet, the chain keeps its state with the share 1 − p − r.
    val keeps  = loss.fold(0.0)(one => 1 - 1 / one.burst / (1 - one.share))
    val bursts = loss.filter(_ => keeps > 1e-6).map: one =>
      val rate = -StrictMath.log(keeps) * packetsPerS
      (lastS = 1 / (rate * (1 - one.share)), betweenS = 1 / (rate * one.share))
    val outages =
      outage.map(one => (lastS = one.lasts.toSeconds, betweenS = (one.every - one.lasts).toSeconds))
    val share    = loss.fold(0.0)(_.share)
    val burstS   = bursts.fold(0.0)(_.lastS * StrictMath.log(share / Chance).max(0))
    val longestS = outages.fold(0.0)(_.lastS).max(burstS)
    val timeout  = Span.ofNanos(math.round(timeoutS * 1e9 / DelayTable.GrainNs) * DelayTable.GrainNs)
    val tries    = Iterator
      .from(0)
      .find: n =>
        (share == 0 || StrictMath.pow(share, n + 1) <= Chance) &&
          longest(timeout, n).toSeconds >= longestS
      .get
    if loss.isEmpty && outage.isEmpty then base
    else
      new LossyDelays(
        base,
        if bursts.isEmpty then share else 0,
        bursts,
        outages,
        timeout,
        tries
      )

/** The times in which one world's link loses everything. Mutable: the times are computed as far as needed. */
private[skein] final class LossTimes(
    val worldKey: Int,
    bursts: Vector[Option[LossStretches]],
    outages: Option[LossStretches]
):
  private val all = bursts.map(own => (own ++ outages).toArray)

  /** Start and end of the loss-free interval that [[isLost]] found last, ns; if everything was lost, the end
    * is not after the requested time.
    */
  var calmFromNs, calmUntilNs = 0L

  /** Whether the link loses everything at a time.
    *
    * @param direction 0 to the server, 1 to the client
    */
  def isLost(direction: Int, atNs: Long): Boolean =
    calmFromNs = Long.MinValue
    calmUntilNs = Long.MaxValue
    val each = all(direction)
    eachBelow(each.length): i =>
      each(i).find(atNs)
      calmFromNs = calmFromNs.max(each(i).endedNs)
      calmUntilNs = calmUntilNs.min(each(i).beginsNs)
    calmUntilNs <= atNs

/** Stretches of time in which everything is lost, with exponentially distributed times between them.
  *
  * @param line the line whose random numbers are used
  * @param isFixed whether all stretches have equal length and the flight begins between two of them;
  *   otherwise their lengths are exponentially distributed, and the flight may begin within one
  */
private[skein] final class LossStretches(
    worldKey: Int,
    line: Int,
    lengths: (lastS: Double, betweenS: Double),
    isFixed: Boolean
):
  private var begins, ends = new Array[Long](8)
  private var count        = 0
  private var drawn        = 0
  private var at           = 0

  private def uniform(): Double =
    drawn += 1
    WorldRandom.uniform(worldKey, drawn * Delays.Lines + line)

  private def exponential(meanS: Double): Double = -StrictMath.log1p(-uniform()) * meanS

  /** End of the last stretch before the time passed to `find`, and begin of the stretch at or after it, ns.
    */
  var endedNs, beginsNs = 0L

  def find(atNs: Long): Unit =
    while count == 0 || ends(count - 1) <= atNs do add()
    if at >= count || ends(at) <= atNs then while ends(at) <= atNs do at += 1
    while at > 0 && ends(at - 1) > atNs do at -= 1
    endedNs = if at == 0 then Long.MinValue else ends(at - 1)
    beginsNs = begins(at)

  private def add(): Unit =
    if count == ends.length then
      begins = java.util.Arrays.copyOf(begins, 2 * count)
      ends = java.util.Arrays.copyOf(ends, 2 * count)
    val beginsInIt = count == 0 && !isFixed && uniform() < lengths.lastS / (lengths.lastS + lengths.betweenS)
    val calmS      = if beginsInIt then 0 else exponential(lengths.betweenS)
    val lostS      = if isFixed then lengths.lastS else exponential(lengths.lastS)
    begins(count) = (if count == 0 then 0 else ends(count - 1)) + (calmS * 1e9).toLong
    ends(count) = begins(count) + (lostS * 1e9).toLong
    count += 1
