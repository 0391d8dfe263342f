package skein.rosbag

import scala.collection.mutable
import skein.units.{Instant, Span}

/** The simulated time of a graph, from the messages on its topic `/clock`. Mutable; times must be given in
  * order.
  *
  * Between two messages the time is assumed to advance at its rate over the last [[GraphClock.MostRecent]]
  * messages, by at most one usual step. So its error is at most one step, at any speed, and while it stands
  * still.
  */
private[rosbag] final class GraphClock:
  import GraphClock.*

  private val recent  = mutable.Queue.empty[Tick]
  private var begun   = Instant.Epoch
  private var steps   = 0L
  private var reached = Instant.Epoch

  /** Adds the time of a message. A time that is older than the newest by up to [[MostLate]] is ignored as
    * late.
    *
    * @param at time of arrival
    * @return whether the time begins here: this is the first message, or the time went back
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

  /** The usual step from one message to the next; None before the first message. */
  def step: Option[Span] = recent.lastOption.map(last => last.time.since(begun) / steps.max(1))

  /** The simulated time of an arrival, or `at` itself if there is no simulated time. It never runs back,
    * except where the time starts again.
    */
  def timeOf(at: Instant): Instant =
    for last <- recent.lastOption; usual <- step do
      val elapsed = last.at.since(recent.head.at).toNanos
      val passed  = last.time.since(recent.head.time).toNanos
      val rate    = if elapsed > 0 then passed.toDouble / elapsed else 0.0
      val beyond  = Span.ofNanos((at.since(last.at).toNanos * rate).toLong)
      reached = reached.max(last.time + beyond.max(Span.Zero).min(usual))
    if recent.isEmpty then at else reached

  /** Whether a node may have read this time from `/clock` by `now`: it is at most two steps old. Nodes stamp
    * their messages with the last message's time, and so may simulators.
    */
  def mayShow(time: Instant, now: Instant): Boolean = step.exists(usual => now.since(time) <= usual * 2)

private object GraphClock:
  final case class Tick(time: Instant, at: Instant)

  val MostRecent: Int = 32

  /** Maximum lateness of a message: best effort may deliver one after a newer one. A simulation that starts
    * again goes back further.
    */
  val MostLate: Span = Span.ofSeconds(1)
