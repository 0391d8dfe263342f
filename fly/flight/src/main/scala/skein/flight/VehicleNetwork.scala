package skein.flight

import java.util.concurrent.atomic.{AtomicReference, LongAdder}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.loop.{Messages, Reading}
import skein.record.{Event, EventKind, Recorder}
import skein.settings.VehicleLink
import skein.signal.{LatencySampler, PacketLoss, SplitMix64}
import skein.units.*

/** The messages between the controllers of a flight's vehicles: each sends one to every other for each
  * reading of its own vehicle, over a link of its own that delays and loses it. The first from one to another
  * always arrives: the vehicles' starts are agreed before.
  *
  * @param names the vehicles' names, by index
  * @param sees whether nothing stands between two positions, NED, m
  * @param recorder gets an event at the end that counts the messages to each vehicle that did not arrive
  */
private[flight] final class VehicleNetwork(
    names: Vector[String],
    link: VehicleLink,
    seed: Long,
    sees: (Vector3, Vector3) => Boolean,
    clock: Clock,
    recorder: Recorder
)(using system: ActorSystem):
  import system.dispatcher
  private val begun = clock.now()

  /** Each vehicle's position at its newest reading. */
  private val places = names.map(_ => AtomicReference(Option.empty[Vector3]))

  private val takers           = names.map(_ => AtomicReference((_: Reading) => ()))
  private val paths            = names.indices.map(from => names.indices.map(Path(from, _)))
  @volatile private var closed = false

  /** The messages of one vehicle's controller. */
  def of(self: Int): Messages = new Messages:
    def send(reading: Reading): Unit =
      places(self).set(Some(reading.state.value.positionNed))
      for path <- paths(self) if path.to != self do path.send(reading)

    def onReceived(take: Reading => Unit): Unit = takers(self).set(take)

  /** Delivers nothing more, and records what was lost. */
  def close(): Future[Done] =
    closed = true
    for (name, to) <- names.zipWithIndex do
      val inward                     = paths.map(_(to))
      def sum(of: Path => LongAdder) = inward.map(of(_).sum).sum
      val (sent, lost, far, hidden)  = (sum(_.sent), sum(_.lost), sum(_.far), sum(_.hidden))
      val missing                    = lost + far + hidden
      if missing > 0 then
        val what =
          s"$missing of $sent messages did not arrive: $lost lost, $far out of range, $hidden out of sight"
        recorder.offer(Event(clock.now(), EventKind.MessagesLost, Some(name), what, count = Some(missing)))
    Future.successful(Done)

  private final class Path(from: Int, val to: Int):
    private val number  = from * names.size + to
    private val sampler =
      LatencySampler(link.profile, SplitMix64.seedOf(seed, 0), SplitMix64.seedOf(seed, 2 + 2 * number))
    private val loss =
      PacketLoss(link.profile, SplitMix64.seedOf(seed, 1), SplitMix64.seedOf(seed, 3 + 2 * number))
    private var isFirst         = true
    val sent, lost, far, hidden = LongAdder()

    def send(reading: Reading): Unit =
      val (isLost, isFree, in) = synchronized:
        val at   = clock.now().since(begun)
        val free = isFirst
        isFirst = false
        (loss.loses(at), free, sampler.oneWay(at))
      val here  = reading.state.value.positionNed
      val there = places(to).get
      sent.increment()
      if isFree then deliver(reading, in)
      else if there.exists(isFar(here, _)) then far.increment()
      else if there.exists(!sees(here, _)) then hidden.increment()
      else if isLost then lost.increment()
      else deliver(reading, in)

    private def isFar(here: Vector3, there: Vector3) = link.range.exists((here - there).norm > _.value)

    private def deliver(reading: Reading, in: Span): Unit =
      val _ = system.scheduler.scheduleOnce(in.toDuration):
        if !closed then takers(to).get()(reading.relayed(from, to, clock.now()))
