package skein.signal

import skein.units.*
import skein.units.Decimals.fixed

/** Estimates the offset between the controller's clock and the simulator's.
  *
  * Physics was sampled at some moment between request and answer, so each reading bounds the offset
  * (controller minus simulator) from both sides: `sentAt − validAt ≤ offset ≤ receivedAt − validAt`. The
  * bounds of all readings hold simultaneously: every short delay in either direction narrows them, and as
  * long as neither clock stops, the offset is within them. Between the bounds it is estimated by assuming
  * that the lower quartile of the latest delays is equal in both directions. (Their minima vary more: over
  * the paper's VPN by 7 ms.)
  *
  * Old bounds are widened by [[ClockAlignment.MaxDrift]] with time, so that clocks of different rates cause
  * no contradiction and the estimate follows them. If readings still contradict each other, the simulator was
  * paused or restarted: estimation restarts, and the restart is counted. The bounds of the last few runs are
  * stored. A late answer from a former run contradicts the present bounds and is compatible with the bounds
  * of that run. It does not affect the present estimate, and counts as older than all readings of the present
  * run, whatever its time stamp.
  *
  * @param lower the offset is at least this
  * @param upper the offset is at most this
  * @param latest bounds from single readings
  * @param validAt valid time of the newest reading, on the simulator's clock
  * @param receivedAt arrival time of the newest reading
  * @param standsStill whether the simulator's clock did not advance between the last two readings
  * @param restarts number of times that estimation restarted
  * @param since arrival time of the present run's first reading
  * @param former former runs, the newest last, as estimated at their ends
  */
final case class ClockAlignment private (
    lower: Span,
    upper: Span,
    private val latest: NewestBounds,
    validAt: Instant,
    receivedAt: Instant,
    standsStill: Boolean,
    restarts: Int,
    since: Instant,
    former: Vector[ClockAlignment]
):
  import ClockAlignment.{FormerRuns, Tick, drift}

  val offset: Span = (Span.ofNanos(latest.quartileFrom - latest.quartileTo) / 2).max(lower).min(upper)

  /** Half width of the interval that contains the offset. */
  def uncertainty: Span = (offset - lower).max(upper - offset)

  /** The controller's time at which the simulator's clock showed `simulatorTime`. */
  def toController(simulatorTime: Instant): Instant = simulatorTime + offset

  /** Time from a reading's sampling to `now`, on the controller's clock. None if the present offset is not
    * valid for the reading: it was sampled before the simulator's clock was reset, and would seem to come
    * from the future.
    */
  def ageOf(reading: Stamped[?], now: Instant): Option[Span] =
    Some(now.since(toController(reading.validAt))).filter(_ >= Span.Zero)

  /** Whether one reading was sampled later than another. This is so if it was requested after the other was
    * received; or else if it is from a later run of the simulator; or else if its time stamp is later. The
    * two readings alone do not suffice: after a restart with an earlier clock, a late answer from the former
    * run has the later time stamp.
    */
  def isNewer(one: Stamped[?], other: Stamped[?]): Boolean =
    if one.sentAt > other.receivedAt then true
    else if other.sentAt > one.receivedAt then false
    else
      val (run, otherRun) = (runOf(one), runOf(other))
      run > otherRun || (run == otherRun && one.validAt > other.validAt)

  /** Whether a reading was sampled in a former run of the simulator. */
  def isOfFormerRun(reading: Stamped[?]): Boolean = runOf(reading) < former.size

  /** The contradiction in a reading because of which [[updated]] restarts estimation; None if it does not. */
  def contradiction(reading: Stamped[?]): Option[String] =
    val next = updated(reading)
    Option.when(next.restarts > restarts):
      if next.standsStill then "the simulator's clock does not advance"
      else
        val lost = (next.lower - upper).max(lower - next.upper).toMillis
        s"the offset of the clocks has changed by ${lost.fixed(1)} ms or more"

  /** The estimate after a reading. A reading from a former run changes nothing. */
  def updated(reading: Stamped[?]): ClockAlignment =
    if isOfFormerRun(reading) then this
    else
      val one   = ClockAlignment.of(reading)
      val still = reading.validAt == validAt && reading.sentAt > receivedAt + Tick
      val slack = drift(since = receivedAt, until = reading.receivedAt)
      val least = (lower - slack).max(one.lower)
      val most  = (upper + slack).min(one.upper)
      if least <= most && !still && !standsStill then
        copy(
          lower = least,
          upper = most,
          latest = latest.updated(ClockAlignment.boundsOf(reading)),
          validAt = validAt.max(reading.validAt),
          receivedAt = receivedAt.max(reading.receivedAt)
        )
      else
        one.copy(
          receivedAt = receivedAt.max(reading.receivedAt),
          standsStill = still,
          restarts = if standsStill then restarts else restarts + 1,
          former =
            if standsStill then former else (former :+ copy(former = Vector.empty)).takeRight(FormerRuns)
        )

  /** Index of a reading's run among the known runs, the present one last. A reading that was requested after
    * a run had begun is from that run or a later one.
    */
  private def runOf(reading: Stamped[?]): Int =
    if reading.sentAt > since || hasTold(reading) then former.size
    else
      former.lastIndexWhere(_.hasTold(reading)) match
        case -1  => former.size
        case run => run

  /** Whether a reading may be from this run: it was received after the run was first observed, and its bounds
    * are compatible with the bounds of the run.
    */
  private def hasTold(reading: Stamped[?]): Boolean =
    val slack = drift(since = receivedAt, until = reading.receivedAt)
    reading.receivedAt >= since &&
    reading.sentAt.since(reading.validAt) <= upper + slack &&
    reading.receivedAt.since(reading.validAt) >= lower - slack

object ClockAlignment:

  /** Number of former runs that are stored; more cannot end before a late answer arrives. */
  val FormerRuns = 4

  /** Maximum drift between the two clocks, seconds per second: about twice that of quartz clocks. */
  val MaxDrift = 100e-6

  /** Longest time for which a running simulator's clock does not advance: three physics steps of AirSim. */
  val Tick: Span = Span.ofMillis(9)

  def of(reading: Stamped[?]): ClockAlignment =
    val bounds = boundsOf(reading)
    ClockAlignment(
      bounds.lower,
      bounds.upper,
      NewestBounds.of(bounds),
      reading.validAt,
      reading.receivedAt,
      standsStill = false,
      restarts = 0,
      since = reading.receivedAt,
      former = Vector.empty
    )

  private def boundsOf(reading: Stamped[?]) =
    NewestBounds.Bounds(reading.sentAt.since(reading.validAt), reading.receivedAt.since(reading.validAt))

  /** The maximum possible drift between the two clocks from one instant to another. */
  private def drift(since: Instant, until: Instant): Span =
    Span.ofNanos(math.ceil(until.since(since).max(Span.Zero).toNanos * MaxDrift).toLong)
