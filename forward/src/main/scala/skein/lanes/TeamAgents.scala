package skein.lanes

import java.util.Arrays
import skein.forward.Duelist

/** What several vehicles of a team compute of one view, in many worlds. Mutable. */
private[lanes] final class TeamViews(val lanes: TeamLanes):
  private val worlds = TimetableAgents.WORLDS
  private val shown  = ViewCall(lanes.shared, lanes.reading)
  private var last   = TeamViews.Nothing

  val values: Array[Float] = Array.ofDim(lanes.shared.outputs * worlds)
  for number <- 0 until lanes.shared.outputs do shown.call.output(number, values, number * worlds)

  def start(): Unit = last = TeamViews.Nothing

  /** Computes [[values]] of a view, unless they stand there already. */
  def show(all: Array[TimetableAgents], views: Array[Int], view: Int): Unit =
    if lanes.shared.outputs > 0 && view != last then
      last = view
      shown.look(all, views, view)
      shown.call.apply()

private object TeamViews:
  private val Nothing = -1

/** One vehicle of a team in many worlds, each with a start and a policy of its own. */
private[lanes] class TeamAgents(self: Int, duelist: Duelist, model: LaneDynamics, team: TeamViews)
    extends TimetableAgents(model.vehicles(duelist.copy(speed = 1))):
  import TeamLanes.Source
  import TimetableAgents.WORLDS

  private val lanes              = team.lanes
  private val bound              = lanes.functions(self)
  private val decision           = ViewCall(bound, lanes.reading)
  private val parameters         = Array.ofDim[Float](lanes.parameters(self) * WORLDS)
  private val elapsed            = Array.ofDim[Float](WORLDS)
  private val startCos, startSin = Array.ofDim[Float](WORLDS)

  // Of the heading before and of the decided one.
  private var cos, sin, newCos, newSin   = Array.ofDim[Float](WORLDS)
  private var asksCos, asksSin, asksTime = TeamAgents.Never

  for (input, place) <- bound.inputs.zipWithIndex if lanes.reading(input).isEmpty do
    lanes.source(input) match
      case Source.Cos               => asksCos = place
      case Source.Sin               => asksSin = place
      case Source.Elapsed           => asksTime = place
      case Source.Parameter(number) => decision.call.input(place, parameters, number * WORLDS)
      case Source.Shared(number)    => decision.call.input(place, team.values, number * WORLDS)

  /** Takes where a world's vehicle starts, and the numbers of its policy, which must be of the form. */
  def take(world: Int, duelist: Duelist, numbers: Array[Double]): Unit =
    vehicles.place(world, duelist)
    startCos(world) = StrictMath.cos(duelist.startHeadingRad).toFloat
    startSin(world) = StrictMath.sin(duelist.startHeadingRad).toFloat
    for number <- numbers.indices do parameters(number * WORLDS + world) = numbers(number).toFloat

  override def start(timetable: Timetable, worlds: Int): Unit =
    super.start(timetable, worlds)
    team.start()
    System.arraycopy(startCos, 0, cos, 0, WORLDS)
    System.arraycopy(startSin, 0, sin, 0, WORLDS)

  /** Cosine and sine of the heading decided last, by world. */
  private[lanes] def direction: (Array[Float], Array[Float]) = (cos, sin)

  override def needsVelocity: Boolean = lanes.needsVelocity

  override def decide(
      all: Array[TimetableAgents],
      views: Array[Int],
      view: Int,
      known: Int,
      before: Int,
      after: Int,
      times: Array[Float],
      number: Int
  ): Unit =
    team.show(all, views, view)
    decision.look(all, views, view)
    if asksCos >= 0 then decision.call.input(asksCos, cos, 0)
    if asksSin >= 0 then decision.call.input(asksSin, sin, 0)
    if asksTime >= 0 then
      Arrays.fill(elapsed, times(number))
      decision.call.input(asksTime, elapsed, 0)
    decision.call.output(0, headings.cos, after)
    decision.call.output(1, headings.sin, after)
    decision.call.output(2, newCos, 0)
    decision.call.output(3, newSin, 0)
    decision.call.apply()
    val (oldCos, oldSin) = (cos, sin)
    cos = newCos; sin = newSin
    newCos = oldCos; newSin = oldSin

private object TeamAgents:
  private val Never = -1
