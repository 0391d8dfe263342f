package skein.rosbag

import scala.collection.mutable
import skein.units.{Instant, Span}

/** The simulated time of a graph, by the messages on its topic `/clock`. Mutable; times in their order.
  *
  * Between two messages it is assumed to go on as fast as it did over the last [[GraphClock.MostRecent]], by
  * one usual step at most. So it is known to within such a step, at any speed, and while it stands still.
  */
private[rosbag] final class GraphClock:
  import GraphClock.*

  private val recent  = mutable.Queue.empty[Tick]
  private var begun   = Instant.Epoch
  private var steps   = 0L
  private var reached = Instant.Epoch

  /** Takes a message's time; one that is up to [[MostLate]] older than the newest is late, and ignored.
    *
    * @param at when the message arrived
    * @return whether the time begins with it: it is the first, or the time went back
    */
  def add(time: Instant, at: Instant): Boolean =
    val begins = recent.lastOption.forall(_.time.since(time) > MostLate)
    if begins then
      recent.clear()
      begun = time
      steps = 0
      reached = time
    if begins || time >= recent.last.time then
      if !begins && time > recent.last.time then steps += 1
      recent += Tick(time, at)
      if recent.size > MostRecent then recent.dequeue(): Unit
    begins

  /** The usual step from one message to the next; None without any message. */
  def step: Option[Span] = recent.lastOption.map(last => last.time.since(begun) / steps.max(1))

  /** The simulated time of an arrival, or `at` itself where there is no simulated time; never runs back, but
    * where it begins anew.
    */
  def timeOf(at: Instant): Instant =
    for last <- recent.lastOption; usual <- step do
      val elapsed = last.at.since(recent.head.at).toNanos
      val passed  = last.time.since(recent.head.time).toNanos
      val rate    = if elapsed > 0 then passed.toDouble / elapsed else 0.0
      val beyond  = Span.ofNanos((at.since(last.at).toNanos * rate).toLong)
      reached = reached.max(last.time + beyond.max(Span.Zero).min(usual))
    if recent.isEmpty then at else reached

  /** Whether a node may read this time from `/clock` at `now`: it is no older than two steps. Nodes stamp
    * with the last message's time, and so may simulators.
    */
  def mayShow(time: Instant, now: Instant): Boolean = step.exists(usual => now.since(time) <= usual * 2)

private object GraphClock:
  final case class Tick(time: Instant, at: Instant)

  val MostRecent: Int = 32

  /** Best effort may deliver a message after a newer one; a simulation that begins anew goes back further. */
  val MostLate: Span = Span.ofSeconds(1)
