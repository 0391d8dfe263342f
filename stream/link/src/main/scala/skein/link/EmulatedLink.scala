package skein.link

import java.util.concurrent.atomic.{AtomicBoolean, AtomicLong, LongAdder}
import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.{BidiFlow, Flow}
import org.apache.pekko.util.ByteString
import skein.signal.{LatencyProfile, LatencySampler, PacketLoss, Retransmission, SplitMix64}
import skein.units.*

/** A link between clients and a server that behaves as a profile specifies, whatever bytes cross it. Its
  * faults' times count from `start`.
  *
  * Equal seeds, clocks and orders of connections give equal delays and faults.
  */
final class EmulatedLink(
    val profile: LinkProfile,
    seed: Long,
    private[link] val clock: Clock,
    start: Instant
):

  def this(profile: LinkProfile, seed: Long, clock: Clock) = this(profile, seed, clock, clock.now())

  private val stateSeed   = SplitMix64.seedOf(seed, 0)
  private val faultSeed   = SplitMix64.seedOf(seed, 1)
  private val attemptSeed = SplitMix64.seedOf(seed, 2)
  private val lineSeed    = SplitMix64.seedOf(seed, 3)
  private val cutSeed     = SplitMix64.seedOf(seed, 4)
  private val outageSeed  = SplitMix64.seedOf(seed, 5)

  private val attempts, connections = AtomicLong()
  private val counters              = LinkCounters()

  private val toServer = Direction(profile.toServer, SplitMix64.seedOf(seed, 6))
  private val toClient = Direction(profile.toClient, SplitMix64.seedOf(seed, 7))

  /** The state of one direction that all connections share. */
  private final class Direction(val latency: LatencyProfile, lossSeed: Long):
    val delivered                      = LongAdder()
    val bottleneck: Option[Bottleneck] = latency.bandwidth.map(Bottleneck(_))
    val loss: PacketLoss               = PacketLoss(latency, outageSeed, lossSeed)
    private val duplicateSeed          = SplitMix64.seedOf(lossSeed, 1)

    /** The losses, repetitions and duplicates of a connection's packets.
      *
      * @param index number that identifies the direction and connection
      */
    def packets(index: Long, isDatagrams: Boolean): Packets =
      if isDatagrams then
        Packets.Datagrams(loss, profile.duplicates, SplitMix64(SplitMix64.seedOf(duplicateSeed, index)))
      else if loss.isAny then
        Packets.Tcp(loss, Retransmission.timeout(latency), Retransmission.overtaken(latency))
      else Packets.Whole

  def counts: LinkCounts = LinkCounts(
    connections.get,
    toServer.delivered.sum,
    toClient.delivered.sum,
    counters.bytesLost.sum,
    counters.stalls.sum,
    counters.disconnects.sum,
    counters.bytesHeldBack.sum,
    Span.ofNanos(counters.longestWaitNs.get),
    counters.packetsLost.sum,
    counters.packetsSentAgain.sum,
    counters.duplicates.sum
  )

  /** A new connection over this link; its first side is at the client, its second at the server. To be
    * materialised once.
    *
    * @param broken the error that both sides get when the link breaks the connection
    * @param isDatagrams whether each piece is a datagram: datagrams are never joined, and have independent
    *   delays, so a later one may arrive first
    */
  def connection(
      broken: TransportError,
      isDatagrams: Boolean = false
  ): BidiFlow[ByteString, ByteString, ByteString, ByteString, NotUsed] =
    val index        = 2 * connections.getAndIncrement()
    val whole        = AtomicBoolean(true)
    def countBreak() = if whole.getAndSet(false) then counters.disconnects.increment()
    def line(direction: Direction, index: Long) =
      val open    = delivery(direction.latency, SplitMix64.seedOf(lineSeed, index), !isDatagrams)
      val delayed = Flow.fromGraph(DelayLine(
        open,
        direction.bottleneck,
        () => sinceStart,
        profile.maxBytesInFlight,
        broken,
        counters,
        direction.delivered,
        () => countBreak(),
        direction.packets(index, isDatagrams)
      ))
      if profile.cutsSegments && !isDatagrams then
        delayed.via(Segments.cut(SplitMix64.seedOf(cutSeed, index)))
      else delayed
    BidiFlow.fromFlows(
      line(toServer, index),
      line(toClient, index + 1)
    )

  /** Time until the request of a client that connects now reaches the server's side, and from then until the
    * answer reaches the client. None if one of the two is lost.
    */
  def handshake(): Option[(toServer: Span, toClient: Span)] =
    val index     = 2 * attempts.getAndIncrement()
    val now       = sinceStart
    val asking    = delivery(profile.toServer, SplitMix64.seedOf(attemptSeed, index))(now)
    val answering = delivery(profile.toClient, SplitMix64.seedOf(attemptSeed, index + 1))(now)
    def leave(direction: Direction, at: Span) =
      val sent = direction.bottleneck.fold(at)(_.free(at))
      sent + direction.loss.delay(sent, Retransmission.First)
    for
      heard    <- asking.due(leave(toServer, now), asking.delay(now))
      answered <- answering.due(leave(toClient, heard), answering.delay(heard))
    yield (toServer = heard - now, toClient = answered - heard)

  private def sinceStart: Span = clock.now().since(start)

  private def delivery(latency: LatencyProfile, seed: Long, isInOrder: Boolean = true)(
      opened: Span
  ): Delivery = Delivery(
    LatencySampler(latency, stateSeed, seed),
    profile.faults.stalls(faultSeed),
    profile.faults.breakOf(opened, faultSeed),
    counters.stalls,
    isInOrder
  )
