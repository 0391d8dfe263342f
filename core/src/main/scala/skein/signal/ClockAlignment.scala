package skein.signal

import skein.units.*

/** What is known of the offset between the controller's clock and the simulator's.
  *
  * Physics was sampled at some moment between request and answer, so each reading bounds the offset (controller minus
  * simulator) from both sides: `sentAt − validAt ≤ offset ≤ receivedAt − validAt`. The bounds of all readings hold at
  * once; they narrow with every fast leg in either direction, and the offset cannot lie outside as long as neither
  * clock stops. Where it lies between the bounds is estimated by assuming that the fastest quarter of the latest legs
  * is alike in both directions, whatever the slower ones are. (Their minima vary more: over the paper's VPN by 7 ms.)
  *
  * Old bounds are widened by [[ClockAlignment.MaxDrift]] with time, so that clocks of different rates neither
  * contradict themselves nor hold the estimate back. If readings contradict each other none the less, the simulator
  * stood still or was restarted: estimation starts afresh, and that is counted.
  *
  * @param lower
  *   the offset is at least this
  * @param upper
  *   the offset is at most this
  * @param latest
  *   what single readings told, the newest last
  * @param validAt
  *   the simulator's time of the newest reading
  * @param receivedAt
  *   when the newest reading arrived
  * @param standsStill
  *   whether the simulator's clock did not advance between the last two readings
  * @param restarts
  *   how often estimation started afresh
  */
final case class ClockAlignment private (
    lower: Span,
    upper: Span,
    latest: Vector[ClockAlignment.Bounds],
    validAt: Instant,
    receivedAt: Instant,
    standsStill: Boolean,
    restarts: Int
):
  import ClockAlignment.{MaxDrift, Memory, Tick, lowQuartile}

  /** Controller's clock minus simulator's. */
  lazy val offset: Span =
    val toSimulator   = lowQuartile(latest)(bounds => Span.Zero - bounds.lower)
    val fromSimulator = lowQuartile(latest)(_.upper)
    ((fromSimulator - toSimulator) / 2).max(lower).min(upper)

  /** The offset lies within ± this. */
  def uncertainty: Span = (offset - lower).max(upper - offset)

  /** The controller's time at which the simulator's clock showed `simulatorTime`. */
  def toController(simulatorTime: Instant): Instant = simulatorTime + offset

  def updated(reading: Stamped[?]): ClockAlignment =
    val one    = ClockAlignment.of(reading)
    val still  = reading.validAt == validAt && reading.sentAt > receivedAt + Tick
    val passed = reading.receivedAt.since(receivedAt).max(Span.Zero)
    val slack  = Span.ofNanos(math.ceil(passed.toNanos * MaxDrift).toLong)
    val least  = (lower - slack).max(one.lower)
    val most   = (upper + slack).min(one.upper)
    val agreed = least <= most && !still && !standsStill
    ClockAlignment(
      if agreed then least else one.lower,
      if agreed then most else one.upper,
      if agreed then (latest ++ one.latest).takeRight(Memory) else one.latest,
      if agreed then validAt.max(reading.validAt) else reading.validAt,
      receivedAt.max(reading.receivedAt),
      still,
      if agreed || standsStill then restarts else restarts + 1
    )

object ClockAlignment:

  /** What one reading tells of the offset. */
  final case class Bounds(lower: Span, upper: Span)

  /** Readings that the estimate between the bounds is made from. */
  val Memory = 128

  /** Of one clock against the other, seconds a second: about twice what quartz clocks differ by. */
  val MaxDrift = 100e-6

  /** A running simulator's clock advances within this: three physics steps of AirSim. */
  val Tick: Span = Span.ofMillis(9)

  /** What a single reading tells. */
  def of(reading: Stamped[?]): ClockAlignment =
    val bounds = Bounds(reading.sentAt.since(reading.validAt), reading.receivedAt.since(reading.validAt))
    ClockAlignment(
      bounds.lower,
      bounds.upper,
      Vector(bounds),
      reading.validAt,
      reading.receivedAt,
      standsStill = false,
      restarts = 0
    )

  /** Sorts numbers, not objects: it is asked for at every reading, and would take a tenth of a virtual flight. */
  private inline def lowQuartile(latest: Vector[Bounds])(inline leg: Bounds => Span): Span =
    val nanos = new Array[Long](latest.size)
    var index = 0
    while index < nanos.length do
      nanos(index) = leg(latest(index)).toNanos
      index += 1
    java.util.Arrays.sort(nanos)
    Span.ofNanos(nanos((nanos.length - 1) / 4))
