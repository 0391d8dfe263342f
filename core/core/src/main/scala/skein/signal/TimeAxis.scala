package skein.signal

import skein.units.*
import skein.units.Decimals.fixed

/** Checks, using only readings, whether the vehicles' clock runs at the rate of the controller's clock.
  *
  * Physics was sampled between request and answer, so a reading bounds the clocks' offset from both sides
  * (see [[ClockAlignment]]). Between two readings the offset has changed by at least the gap between their
  * bounds, however late the answers were. So neither delays of the network nor a busy controller can make a
  * clock look wrong. The readings of each vehicle within the last [[TimeAxis.Window]] are compared with each
  * other, and with those of the other vehicles, which share the clock.
  *
  * A clock that runs back, or whose offset changes by more than [[TimeAxis.Most]] within the window, is
  * useless for distances and ages: that is a [[fault]], permanently. Slower changes are reported by
  * [[wandering]].
  *
  * @param fault description of the clock's fault, in one line for the user
  */
final case class TimeAxis private (
    private val seen: Map[String, TimeAxis.Seen],
    fault: Option[String]
):
  import TimeAxis.*

  /** The state after one more reading. After a fault nothing changes. */
  def updated(vehicle: String, reading: Stamped[?]): TimeAxis =
    if fault.isDefined then this
    else
      val one = Sample(
        vehicle,
        reading.validAt.toNanos,
        reading.sentAt.toNanos,
        reading.receivedAt.toNanos
      )
      val own = seen.get(vehicle).fold(Seen.of(one))(_.updated(one))
      val all = seen.updated(vehicle, own)
      TimeAxis(all, ranBack(one).orElse(leapt(own)).orElse(differs(all)))

  /** A report that the clock does not keep pace, though it has no fault: its offset has changed by more than
    * [[TimeAxis.Told]] within the window.
    */
  def wandering: Option[String] =
    if fault.isDefined || seen.isEmpty then None
    else
      val worst = seen.values.maxBy(_.gapNanos)
      Option.when(worst.gapNanos > Told.toNanos)(worst.text)

  /** A report of two samples whose order is different on the controller's and on the vehicles' clock. */
  private def ranBack(one: Sample): Option[String] =
    val before = seen.values.map(_.newest).filter(other =>
      other.receivedNanos < one.sentNanos && minus(other.validNanos, one.validNanos) > Tick.toNanos
    )
    before.find(_.vehicle == one.vehicle) match
      case Some(own) =>
        Some(
          s"the simulator's clock ran back by ${seconds(minus(own.validNanos, one.validNanos))} " +
            s"between two readings of ${one.vehicle}"
        )
      case None => before.headOption.map: other =>
          val by = seconds(minus(other.validNanos, one.validNanos))
          if seen.get(one.vehicle).exists(_.newest.validNanos <= one.validNanos) then differ(other, one, by)
          else
            s"the simulator's clock ran back by $by between readings of ${other.vehicle} and ${one.vehicle}"

  private def leapt(own: Seen): Option[String] = Option.when(own.gapNanos > Most.toNanos)(own.text)

  /** A report that the vehicles' clocks differ, although each keeps pace by itself. */
  private def differs(all: Map[String, Seen]): Option[String] =
    val (late, early) = (all.values.map(_.latest).maxBy(_.lower), all.values.map(_.earliest).minBy(_.upper))
    val gap           = minus(late.lower, early.upper)
    Option.when(gap > Told.toNanos && all.values.forall(_.keepsPace)):
      differ(late, early, seconds(gap))

object TimeAxis:

  val begun: TimeAxis = TimeAxis(Map.empty, None)

  /** Checks readings in the order of their arrival.
    *
    * @return a description of the clock's fault, if any
    */
  def fault(readings: Iterator[(String, Stamped[?])]): Option[String] =
    readings.scanLeft(begun)((axis, one) => axis.updated(one._1, one._2)).collectFirst:
      case TimeAxis(_, Some(fault)) => fault

  /** Checks a simulator that is stopped and stepped: every step must last about its nominal time.
    *
    * @param before newest time of the previous step
    * @param oldest oldest time of this step's readings
    * @param newest newest time of this step's readings
    * @return a description of the fault, if any
    */
  def steppedFault(before: Option[Instant], oldest: Instant, newest: Instant, period: Span): Option[String] =
    val passed  = minus(newest.toNanos, oldest.toNanos)
    val stepped = before.map(at => minus(newest.toNanos, at.toNanos))
    if passed > period.toNanos then
      Some(s"${seconds(passed)} of the simulator's time passed between readings of one moment: it does not " +
        "stand still, or its vehicles' clocks differ")
    else
      stepped.collect:
        case took if took < 0 => s"the simulator's clock ran back by ${seconds(-took)} in a step"
        case took if took < period.toNanos / 4 =>
          s"the simulator's clock stood still in a step of ${seconds(period.toNanos)}"
        case took if took > 2 * period.toNanos =>
          s"the simulator's clock advanced by ${seconds(took)} in a step of ${seconds(period.toNanos)}"

  /** Duration of the window within which readings are compared, on the controller's clock. */
  val Window: Span = Span.ofSeconds(10)

  /** Maximum change of the offset within the window, a twentieth of the window. A simulator that keeps up
    * with real time stays far below this; on an overloaded machine it loses some tenths of a second.
    */
  val Most: Span = Span.ofMillis(500)

  /** Change of the offset from which [[wandering]] reports it, and difference from which two vehicles' clocks
    * count as different: about the age of readings over a slow link.
    */
  val Told: Span = Span.ofMillis(100)

  /** Tolerance between readings of one moment: three physics steps of AirSim. */
  private val Tick = ClockAlignment.Tick

  private val BucketNanos = 1_000_000_000L
  private val Buckets     = (Window.toNanos / BucketNanos).toInt

  /** The times of a reading, ns; the first is on the vehicles' clock. */
  private final case class Sample(vehicle: String, validNanos: Long, sentNanos: Long, receivedNanos: Long):
    /** Lower bound of the offset, controller minus simulator, ns. */
    val lower: Long = minus(sentNanos, validNanos)

    val upper: Long       = minus(receivedNanos, validNanos)
    def middleNanos: Long = sentNanos + (receivedNanos - sentNanos) / 2
    def bucket: Long      = receivedNanos / BucketNanos

  /** Of a vehicle's readings in one second, the one with the largest lower bound of the offset and the one
    * with the smallest upper bound.
    */
  private final case class Second(latest: Sample, earliest: Sample)

  /** A vehicle's readings in the window.
    *
    * @param still the first of the newest readings that have equal time stamps
    */
  private final case class Seen(newest: Sample, still: Sample, seconds: Vector[Second]):
    /** Reading with the largest lower bound in the window. */
    val latest: Sample   = seconds.map(_.latest).maxBy(_.lower)
    val earliest: Sample = seconds.map(_.earliest).minBy(_.upper)

    /** Smallest change of the offset within the window that explains the readings, ns. */
    def gapNanos: Long = minus(latest.lower, earliest.upper)

    def keepsPace: Boolean = gapNanos < Tick.toNanos && seconds.size > 2

    def updated(one: Sample): Seen =
      val kept = seconds.filter(second => one.bucket - second.latest.bucket < Buckets)
      val next = kept.lastOption match
        case Some(last) if last.latest.bucket == one.bucket =>
          kept.init :+ Second(
            latest = if one.lower > last.latest.lower then one else last.latest,
            earliest = if one.upper < last.earliest.upper then one else last.earliest
          )
        case _ => kept :+ Second(one, one)
      Seen(
        if one.receivedNanos > newest.receivedNanos then one else newest,
        if one.validNanos == newest.validNanos then still else one,
        next
      )

    private def isStill = newest.sentNanos - still.receivedNanos > Most.toNanos / 2

    /** Describes the change between the two readings that differ most. */
    def text: String =
      val (from, to) =
        if latest.receivedNanos < earliest.receivedNanos then (latest, earliest) else (earliest, latest)
      val advanced = minus(to.validNanos, from.validNanos)
      val passed   = TimeAxis.seconds(minus(to.middleNanos, from.middleNanos))
      val clock    = "the simulator's clock"
      val of       = s", by readings of ${newest.vehicle}"
      if advanced < 0 then s"$clock ran back by ${TimeAxis.seconds(-advanced)} while $passed passed$of"
      else if isStill then
        s"$clock stood still for ${TimeAxis.seconds(newest.middleNanos - still.middleNanos)}$of"
      else s"$clock advanced by ${TimeAxis.seconds(advanced)} while $passed passed$of"

  private object Seen:
    def of(one: Sample): Seen = Seen(one, one, Vector(Second(one, one)))

  private def differ(one: Sample, other: Sample, by: String) =
    s"the clocks of ${one.vehicle} and ${other.vehicle} differ by $by or more: vehicles of one flight share one"

  /** The difference, limited to the range of `Long`, since time stamps may have any value. */
  private def minus(one: Long, other: Long): Long =
    val difference = one - other
    if ((one ^ other) & (one ^ difference)) < 0 then if one < 0 then Long.MinValue else Long.MaxValue
    else difference

  private def seconds(nanos: Long): String = s"${(nanos * 1e-9).fixed(2)} s"
