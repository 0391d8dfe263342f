package skein.lanes.loop

import skein.forward.*
import skein.lanes.timetable.StandingStill
import skein.units.eachBelow
import skein.vehicle.SensorNoise

/** The views of one world under the `stream` loop, in order, including requests that are overtaken, late,
  * failed, or held back by a full window. Views do not depend on decisions, so the loop's own joining
  * computes them ahead. [[LaneViews]] computes the regular views of many worlds with SIMD, and uses this
  * class for irregular views. Mutable.
  *
  * @param ahead periods within which the requests of a regular view are answered
  */
private[lanes] final class ViewSource private (
    timing: LoopTiming.Stream,
    world: RolloutWorld,
    link: StandingStill.Link,
    durationS: Double,
    ahead: Int
) extends JoiningRun(timing, world):
  import ViewSource.Never

  private val periodNs = Nanos.of(timing.periodS)
  // As many whole periods as the scalar engine's.
  private val endNs    = (durationS / timing.periodS).round * periodNs
  private var isJoined = false

  /** When the present view was joined, ns; [[ViewSource.Never]] if the flight ends before. */
  var joinedAt = Never

  /** Whether the present view consists of its period's requests, and nothing older is still pending. */
  var isRegular = false

  /** The latest tick at which a request of the view, or of the view before, was sent. */
  var row = 0

  /** By vehicle: whether its reading differs from that of the view before. */
  val isFresh: Array[Boolean] = Array.ofDim(world.count)

  /** By vehicle: the view's request, and when it reached the vehicle, ns. */
  def question: Array[Int]   = observation.reading
  def sampledAt: Array[Long] = observation.validAtNs

  def controllers: Array[Controller] = Array.empty

  /** Starts at a request, once all earlier requests, if any, are answered and joined. */
  def begin(worldKey: Int, worldLink: TabledDelays, first: Int): Unit =
    link.delays = worldLink
    world.start(worldKey, LoopObserver.Nobody, first)
    row = first - 1
    isRegular = false
    java.util.Arrays.fill(question, first - 1)
    java.util.Arrays.fill(sampledAt, Long.MinValue)
    begin(first)

  /** Advances to the next view, or to the flight's end. */
  def next(): Unit =
    isJoined = false
    while !isJoined && world.nextNs <= endNs do handle(world.next())
    if !isJoined then
      joinedAt = Never
      row = Int.MaxValue
      isRegular = false

  protected def joined(): Unit =
    isJoined = true
    joinedAt = world.nowNs
    eachBelow(world.count): vehicle =>
      isFresh(vehicle) = !waiting(vehicle)
      if sampledAt(vehicle) > Long.MinValue then row = row.max(tickOf(vehicle))
    val ticks = (world.nowNs / periodNs).toInt + 1
    isRegular = world.nowNs < (row + ahead) * periodNs
    var vehicle = 0
    while isRegular && vehicle < world.count do
      isRegular = question(vehicle) == row && tickOf(vehicle) == row &&
        sampledAt(vehicle) < (row + 1) * periodNs && questions(vehicle).isUpTo(row, ticks) &&
        areInTime(vehicle, ticks)
      vehicle += 1

  /** Whether none of the requests after the view's had to wait. */
  private def areInTime(vehicle: Int, ticks: Int): Boolean =
    var next = row + 1
    while next < ticks && world.sentAtNs(world.slot(vehicle, next)) == next * periodNs do next += 1
    next >= ticks

  /** The tick at which the view's request to a vehicle was sent. */
  private def tickOf(vehicle: Int): Int =
    (world.sentAtNs(world.slot(vehicle, question(vehicle))) / periodNs).toInt

private[lanes] object ViewSource:
  val Never: Long = Long.MaxValue

  /** Makes the source.
    *
    * @param noise decides which readings are missing, by vehicle; null where none is
    * @param maxDelayS the longest one-way delay of any link
    */
  def apply(
      timing: LoopTiming.Stream,
      noise: Array[SensorNoise],
      durationS: Double,
      maxDelayS: Double,
      ahead: Int
  ): ViewSource =
    val vehicles = noise.length
    val link     = StandingStill.Link()
    val longestS = timing.asking.timeoutS.min(2 * maxDelayS)
    val world    = RolloutWorld(
      StandingStill.engagement(vehicles, durationS),
      link,
      noise.map(each => StandingStill.Response(noise = Option(each))).toVector,
      timing.asking,
      keepsAll = false,
      asksPolicies = false,
      standsStill = false,
      // Besides a slow request, those sent meanwhile are pending, and as many for the request of the last
      // view, which may have been answered when the slow one was sent.
      ring = 2 * (longestS / timing.periodS).ceil.toInt + timing.asking.window + 2
    )
    new ViewSource(timing, world, link, durationS, ahead)
