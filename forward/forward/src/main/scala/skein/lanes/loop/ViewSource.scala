package skein.lanes.loop

import skein.forward.*
import skein.lanes.timetable.StandingStill

/** The views of one world under the `stream` loop, one after the other, with all that can happen to
  * questions: overtaken, late, failed, held back by a full window. No view depends on what is decided, so the
  * loop's own joining tells them ahead. [[LaneViews]] tells views in which nothing of this happens, many
  * worlds at a time, and asks here for the others. Mutable.
  *
  * @param ahead rows within which the questions of a regular view are answered
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
  private val endNs    = Nanos.of(durationS)
  private var isJoined = false

  /** When the view told last was joined, ns; [[ViewSource.Never]] if the flight ends before. */
  var joinedAt = Never

  /** Whether the view told last is that of its row's questions, and nothing older is left behind it. */
  var isRegular = false

  /** The latest of the ticks at which the view's questions were asked, or that of the view before. */
  var row = 0

  /** By vehicle: whether the view before had another reading. */
  val isFresh: Array[Boolean] = Array.ofDim(world.count)

  /** By vehicle: the view's question, and when it reached the vehicle, ns. */
  def question: Array[Int]   = observation.reading
  def sampledAt: Array[Long] = observation.validAtNs

  def controllers: Array[Controller] = Array.empty

  /** Begins at a question when all questions before are answered and joined, if there were any. */
  def begin(worldKey: Int, worldLink: TabledDelays, first: Int): Unit =
    link.delays = worldLink
    world.start(worldKey, LoopObserver.Nobody, first)
    row = first - 1
    isRegular = false
    java.util.Arrays.fill(question, first - 1)
    java.util.Arrays.fill(sampledAt, Long.MinValue)
    begin(first)

  /** Goes on to the next view. */
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
    var vehicle = 0
    while vehicle < world.count do
      isFresh(vehicle) = !waiting(vehicle)
      if sampledAt(vehicle) > Long.MinValue then row = row.max(tickOf(vehicle))
      vehicle += 1
    val ticks = (world.nowNs / periodNs).toInt + 1
    isRegular = world.nowNs < (row + ahead) * periodNs
    vehicle = 0
    while isRegular && vehicle < world.count do
      isRegular = question(vehicle) == row && tickOf(vehicle) == row &&
        sampledAt(vehicle) < (row + 1) * periodNs && questions(vehicle).isUpTo(row, ticks) &&
        areInTime(vehicle, ticks)
      vehicle += 1

  /** Whether none of the questions behind the view's had to wait. */
  private def areInTime(vehicle: Int, ticks: Int): Boolean =
    var next = row + 1
    while next < ticks && world.sentAtNs(world.slot(vehicle, next)) == next * periodNs do next += 1
    next >= ticks

  /** At which the view's question to a vehicle was asked. */
  private def tickOf(vehicle: Int): Int =
    (world.sentAtNs(world.slot(vehicle, question(vehicle))) / periodNs).toInt

private[lanes] object ViewSource:
  val Never: Long = Long.MaxValue

  /** @param maxDelayS the longest one-way delay of any link */
  def apply(
      timing: LoopTiming.Stream,
      vehicles: Int,
      durationS: Double,
      maxDelayS: Double,
      ahead: Int
  ): ViewSource =
    val link     = StandingStill.Link()
    val longestS = timing.asking.timeoutS.min(2 * maxDelayS)
    val world    = RolloutWorld(
      StandingStill.engagement(vehicles, durationS),
      link,
      StandingStill.Response(),
      timing.asking,
      keepsAll = false,
      standsStill = false,
      // With a question that takes long, those asked meanwhile, and as many for the one told last, whose
      // answer may have come as it was asked.
      ring = 2 * (longestS / timing.periodS).ceil.toInt + timing.asking.window + 2
    )
    new ViewSource(timing, world, link, durationS, ahead)
